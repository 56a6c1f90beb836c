// Media in which a small part shines: what their uncollided light costs and how wrong it is.
//
//   TyndallBenchEmission [--quick] [--edge 128] [--voxels 60] [--pairs 20000] [--error E] [--only WORDS] [--seed N]
//
// A line a scene, without scattering:
//   seconds, core_seconds  of the solve, less one that leaves this light to directions; the latter of all threads
//   rms, worst_twentieth   of single voxels that lie by chance outside what shines: relative error of fluence beside
//                          `pairs` pairs of points, one by chance in the voxel and one in what shines; root mean
//                          square, and what a twentieth of the voxels exceeds
//   mean                   of these errors: 0 but for chance, or light is lost
//   reference_error        root mean square of the standard errors of that comparison

#include "EmissionScenes.h"
#include "Measure.h"
#include "Program.h"
#include "Report.h"

#include "Device/HostThreads.h"
#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "Reference/OpticalLength.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>
#include <stdexcept>

using namespace bench;
using namespace tyndall;

namespace
{
struct Options
{
  int edge = 128, voxels = 60, pairs = 20000;
  unsigned seed = 1;
  double error = 0.0; ///< 0: each scene's own
  std::string only;   ///< scenes whose name has it
};

Options OptionsOf(const Arguments& arguments)
{
  Options options;
  if (arguments.quick)
  {
    options.edge = 24;
    options.voxels = 8;
    options.pairs = 500;
    options.only = "tau 2";
  }
  for (std::size_t i = 0; i + 1 < arguments.words.size(); i += 2)
  {
    const std::string &word = arguments.words[i], &value = arguments.words[i + 1];
    const double number = std::atof(value.c_str());
    if (word == "--edge")
    {
      options.edge = static_cast<int>(number);
    }
    else if (word == "--voxels")
    {
      options.voxels = static_cast<int>(number);
    }
    else if (word == "--pairs")
    {
      options.pairs = static_cast<int>(number);
    }
    else if (word == "--error")
    {
      options.error = number;
    }
    else if (word == "--seed")
    {
      options.seed = static_cast<unsigned>(number);
    }
    else if (word == "--only")
    {
      options.only = value;
    }
    else
    {
      throw std::runtime_error("TyndallBenchEmission: what is " + word + "? See the top of Emission.cxx.");
    }
  }
  return options;
}

struct Estimate
{
  double mean, standardError;
};

/// Mean fluence of a voxel in one channel, W / length^2, from pairs of points.
Estimate MeanFluence(const EmissionScene& scene, std::size_t voxel, int channel, int pairs)
{
  const Grid& grid = scene.medium.grid;
  std::mt19937_64 random(voxel);
  std::uniform_real_distribution<double> uniform;
  const std::array<int, 3> at = grid.VoxelAt(voxel);
  double volume = grid.VoxelVolume(), sum = 0.0, squares = 0.0;
  for (int a = 0; a < 3; ++a)
  {
    volume *= scene.sourceSize[a];
  }
  for (int i = 0; i < pairs; ++i)
  {
    std::array<double, 3> from, to; // voxels
    std::array<int, 3> shining;
    double squared = 0.0;
    for (int a = 0; a < 3; ++a)
    {
      from[a] = at[a] + uniform(random);
      to[a] = scene.sourceFirst[a] + scene.sourceSize[a] * uniform(random);
      shining[a] = static_cast<int>(to[a]);
      squared += std::pow((to[a] - from[a]) * grid.spacing[a], 2);
    }
    const double brightness = scene.medium.emission.At(grid.IndexOf(shining), channel);
    const double value = brightness > 0.0 ? brightness * volume *
        std::exp(-OpticalLength(grid.size, grid.spacing, scene.sigma_a.data(), from, to)) / squared
                                          : 0.0;
    sum += value;
    squares += value * value;
  }
  const double mean = sum / pairs;
  return { mean, std::sqrt(std::max(0.0, squares / pairs - mean * mean) / pairs) };
}

/// Voxels by chance, none of them next to what shines or in it.
std::vector<std::size_t> ChooseVoxels(const EmissionScene& scene, const Options& options)
{
  const Grid& grid = scene.medium.grid;
  std::mt19937 random(options.seed);
  std::uniform_int_distribution<std::size_t> any(0, grid.VoxelCount() - 1);
  std::vector<std::size_t> voxels;
  while (static_cast<int>(voxels.size()) < options.voxels)
  {
    const std::size_t voxel = any(random);
    const std::array<int, 3> at = grid.VoxelAt(voxel);
    bool outside = false;
    for (int a = 0; a < 3; ++a)
    {
      const int end = scene.sourceFirst[a] + scene.sourceSize[a];
      outside = outside || at[a] < scene.sourceFirst[a] - 1 || at[a] > end;
    }
    if (outside)
    {
      voxels.push_back(voxel);
    }
  }
  return voxels;
}

struct Errors
{
  double rms = 0.0, worstTwentieth = 0.0, mean = 0.0, reference = 0.0;
};

Errors Compare(const EmissionScene& scene, const LightField& light, const Options& options)
{
  const std::vector<std::size_t> voxels = ChooseVoxels(scene, options);
  std::vector<double> errors(voxels.size()), standardErrors(voxels.size());
  InThreads(voxels.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
    {
      const int channel = static_cast<int>(i) % light.channels;
      const Estimate estimate = MeanFluence(scene, voxels[i], channel, options.pairs);
      errors[i] = light.fluence[voxels[i] * light.channels + channel] / estimate.mean - 1.0;
      standardErrors[i] = estimate.standardError / estimate.mean;
    }
  });
  const double count = static_cast<double>(voxels.size());
  Errors result;
  for (std::size_t i = 0; i < voxels.size(); ++i)
  {
    result.rms += errors[i] * errors[i] / count;
    result.mean += errors[i] / count;
    result.reference += standardErrors[i] * standardErrors[i] / count;
    errors[i] = std::abs(errors[i]);
  }
  std::sort(errors.begin(), errors.end());
  result.rms = std::sqrt(result.rms);
  result.reference = std::sqrt(result.reference);
  result.worstTwentieth = errors[static_cast<std::size_t>(0.95 * (count - 1.0))];
  return result;
}

struct Run
{
  double seconds, coreSeconds;
  LightField light;
};

Run Solve(Device& device, const EmissionScene& scene, double error)
{
  PropagationSettings settings;
  settings.maximumOrders = 1;
  settings.emissionError = error;
  const double start = WallSeconds(), coreStart = CoreSeconds();
  LightField light = SolveConservative(device, scene.medium, {}, settings);
  return { WallSeconds() - start, CoreSeconds() - coreStart, std::move(light) };
}

void Show(Device& device, const EmissionScene& scene, const Options& options)
{
  const double error = options.error > 0.0 ? options.error : scene.error;
  const Run directions = Solve(device, scene, 0.0);
  const Run rays = Solve(device, scene, error);
  const Errors errors = Compare(scene, rays.light, options);
  const std::array<int, 3>& size = scene.medium.grid.size;
  JsonLine line;
  line.Add("bench", "emission")
    .Add("case", scene.name)
    .Add("method", "conservative, one order")
    .Add("grid", std::to_string(size[0]) + "x" + std::to_string(size[1]) + "x" + std::to_string(size[2]))
    .Add("emission_error", error)
    .Add("seconds", rays.seconds - directions.seconds)
    .Add("core_seconds", rays.coreSeconds - directions.coreSeconds)
    .Add("rms", errors.rms)
    .Add("worst_twentieth", errors.worstTwentieth)
    .Add("mean", errors.mean)
    .Add("reference_error", errors.reference)
    .Add("rms_of_directions", Compare(scene, directions.light, options).rms)
    .Print();
}

void RunAll(Device& device, const Arguments& arguments)
{
  const Options options = OptionsOf(arguments);
  Solve(device, EmissionScenes(16)[0], 0.02); // compiles
  for (const EmissionScene& scene : EmissionScenes(options.edge))
  {
    if (scene.name.find(options.only) != std::string::npos)
    {
      Show(device, scene, options);
    }
  }
}
}

int main(int argc, char* argv[])
{
  return RunOnDevice(argc, argv, RunAll);
}
