#include "DeviceTest.h"
#include "MediumScene.h"

#include "LightPropagation/Directions.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

using namespace tyndall;

// A medium without end, sigma_t and sigma_s everywhere the same, that shines q(x) = 1 + a cos(k x). Along a ray the wave comes with
// exp(-sigma_t s), so an isotropic source cos(k x) of strength 1 makes the fluence A cos(k x) 4 pi with
//   A = mean over directions of sigma_t / (sigma_t^2 + (k omega)^2) = atan(|k| / sigma_t) / |k|;
// the source itself is q + sigma_s fluence / (4 pi). Summed up:
//   fluence = 4 pi (1 / sigma_a + a cos(k x) A / (1 - sigma_s A)).
// With a set of directions A is the set's mean, which tells the error of voxels from that of directions.
namespace
{
constexpr double Pi = 3.14159265358979323846;
constexpr double Amplitude = 0.5;

struct Wave
{
  std::array<int, 3> periods; ///< in the box
  double thickness;           ///< sigma_t times the box's edge
  double albedo;
};

constexpr double Edge = 1.0;

double Length(const std::array<double, 3>& v)
{
  return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

std::array<double, 3> WaveVector(const Wave& wave)
{
  std::array<double, 3> k;
  for (int a = 0; a < 3; ++a)
  {
    k[a] = 2.0 * Pi * wave.periods[a] / Edge;
  }
  return k;
}

double InAllDirections(const Wave& wave)
{
  const double k = Length(WaveVector(wave));
  return std::atan(k * Edge / wave.thickness) / k;
}

double InSet(const Wave& wave, int perFace)
{
  const std::array<double, 3> k = WaveVector(wave);
  const double sigma_t = wave.thickness / Edge;
  double sum = 0.0;
  for (const Direction& d : SoundDirections(perFace).directions)
  {
    const double along = k[0] * d.omega[0] + k[1] * d.omega[1] + k[2] * d.omega[2];
    sum += d.weight * sigma_t / (sigma_t * sigma_t + along * along);
  }
  return sum / (4.0 * Pi);
}

/// Along axes where nothing changes a few voxels do, of the same size: the box has no end there either.
std::array<int, 3> Size(const Wave& wave, int voxels)
{
  std::array<int, 3> size;
  for (int a = 0; a < 3; ++a)
  {
    size[a] = wave.periods[a] == 0 ? 2 : voxels;
  }
  return size;
}

/// Mean of cos(k x) over each voxel, by axes: of x periods of wave, mean over the voxel is sinc times the middle's.
std::vector<double> MeanWave(const Wave& wave, int voxels)
{
  const std::array<double, 3> k = WaveVector(wave);
  const double h = Edge / voxels;
  double mean = 1.0;
  for (double ofAxis : k)
  {
    mean *= ofAxis == 0.0 ? 1.0 : std::sin(0.5 * ofAxis * h) / (0.5 * ofAxis * h);
  }
  std::vector<double> values;
  const std::array<int, 3> size = Size(wave, voxels);
  for (int z = 0; z < size[2]; ++z)
  {
    for (int y = 0; y < size[1]; ++y)
    {
      for (int x = 0; x < size[0]; ++x)
      {
        values.push_back(mean * std::cos(k[0] * (x + 0.5) * h + k[1] * (y + 0.5) * h + k[2] * (z + 0.5) * h));
      }
    }
  }
  return values;
}

/// Root mean square of (fluence - exact) over that of the wave in `exact`.
double Error(Device& device, const Wave& wave, int voxels, int perFace, PropagationSource source, double average)
{
  const double sigma_t = wave.thickness / Edge;
  const double sigma_s = wave.albedo * sigma_t;
  Scene scene(Size(wave, voxels), static_cast<float>(sigma_t - sigma_s), static_cast<float>(sigma_s));
  scene.medium.grid.spacing = { Edge / voxels, Edge / voxels, Edge / voxels };
  scene.settings.periodic = { true, true, true };
  scene.settings.directionsPerFace = perFace;
  scene.settings.source = source;
  scene.settings.acceleration = PropagationAcceleration::Automatic;
  scene.settings.tolerance = 1e-6;
  const std::vector<double> waves = MeanWave(wave, voxels);
  for (double value : waves)
  {
    scene.emission.push_back(static_cast<float>(1.0 + Amplitude * value));
  }
  const LightField light = scene.Solve(device);
  const double height = Amplitude * average / (1.0 - sigma_s * average);
  double error = 0.0, all = 0.0;
  for (std::size_t i = 0; i < waves.size(); ++i)
  {
    const double exact = 4.0 * Pi * (1.0 / (sigma_t - sigma_s) + height * waves[i]);
    error += (light.fluence[i] - exact) * (light.fluence[i] - exact);
    all += std::pow(4.0 * Pi * height * waves[i], 2);
  }
  return std::sqrt(error / all);
}

const std::vector<Wave> Waves = { { { 1, 0, 0 }, 1.0, 0.5 }, { { 1, 0, 0 }, 20.0, 0.9 }, { { 1, 1, 0 }, 1.0, 0.5 },
  { { 1, 1, 1 }, 20.0, 0.9 }, { { 1, 2, 0 }, 100.0, 0.99 } };

std::string Name(const Wave& wave)
{
  std::string name;
  for (int periods : wave.periods)
  {
    name += std::to_string(periods);
  }
  return name + " thickness " + std::to_string(static_cast<int>(wave.thickness));
}
}

class ManufacturedSolution : public DeviceTest
{
};

TEST_F(ManufacturedSolution, Probe)
{
  for (const Wave& wave : Waves)
  {
    for (PropagationSource source : { PropagationSource::Constant, PropagationSource::Linear })
    {
      std::printf("%s albedo %g %s:", Name(wave).c_str(), wave.albedo, source == PropagationSource::Linear ? "linear" : "constant");
      double last = 0.0;
      for (int voxels : wave.periods[2] ? std::vector<int>{ 8, 16, 32, 48 } : wave.periods[1] ? std::vector<int>{ 8, 16, 32, 64, 128 } : std::vector<int>{ 8, 16, 32, 64, 128, 256, 512 })
      {
        const double error = Error(this->GetDevice(), wave, voxels, 36, source, InSet(wave, 36));
        std::printf("  %d: %.3e (%.2f)", voxels, error, last > 0.0 ? std::log2(last / error) : 0.0);
        last = error;
      }
      std::printf("\n");
    }
    std::printf("  directions:");
    double last = 0.0;
    for (int edge : { 2, 4, 8, 16, 32 })
    {
      const double error = std::abs(InSet(wave, edge * edge) / InAllDirections(wave) - 1.0);
      std::printf("  %d: %.3e (%.2f)", edge, error, last > 0.0 ? std::log2(last / error) : 0.0);
      last = error;
    }
    std::printf("\n");
  }
}
