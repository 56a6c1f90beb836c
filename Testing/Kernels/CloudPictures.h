#pragma once

#include "FractalCloud.h"

#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "Reference/PictureMonteCarlo.h"
#include "Viewing/MediumRayCaster.h"

#include <array>
#include <cmath>
#include <vector>

/// A user's cloud under a sun and a sky, its pictures by the ray caster and by Monte Carlo.
namespace cloud_pictures
{
struct View
{
  const char* name;
  std::array<double, 3> towards; ///< from the cloud to the camera
};
inline constexpr View Views[] = { { "sun behind the camera", { -1.0, 0.25, 0.15 } },
  { "from the side", { 0.1, -1.0, 0.12 } }, { "against the sun", { 1.0, 0.1, -0.05 } } };

struct Setup
{
  int edge = 128;                            ///< voxels
  std::array<int, 2> imageSize = { 64, 56 }; ///< pixels
  double thickness = 50.0, albedo = 0.9999, g = 0.85;
  double sunElevation = 20.0; ///< degrees; it travels along +x
  double sun = 1000.0, sky = 25.0;

  std::array<double, 3> SunTravels() const
  {
    const double angle = this->sunElevation * 3.14159265358979323846 / 180.0;
    return { std::cos(angle), 0.0, -std::sin(angle) };
  }
  tyndall::Grid Grid() const
  {
    tyndall::Grid grid;
    grid.size = { this->edge, this->edge, this->edge };
    grid.spacing = { 1.0 / this->edge, 1.0 / this->edge, 1.0 / this->edge };
    return grid;
  }
  tyndall::Camera CameraOf(const View& view) const
  {
    tyndall::Camera camera =
      FrameGrid(this->Grid(), static_cast<double>(this->imageSize[0]) / this->imageSize[1], 30.0, view.towards);
    camera.viewAngle = 16.5; // of the cloud, not of the air around
    return camera;
  }
};

/// That of Data/Reference/cloud_pictures.csv.
inline Setup SmallCloud()
{
  Setup setup;
  setup.edge = 24;
  setup.imageSize = { 16, 14 };
  setup.thickness = 8.0;
  return setup;
}

/// How the cloud is solved, and with which g.
struct Method
{
  const char* name;
  double g;
  int degree;
  int directionsPerFace;
};

inline constexpr Method Methods[] = { { "isotropic, g = 0", 0.0, 0, 25 }, { "similarity", 0.85, 0, 25 },
  { "degree 1", 0.85, 1, 25 }, { "degree 3", 0.85, 3, 25 }, { "degree 5", 0.85, 5, 25 }, { "degree 7", 0.85, 7, 25 } };

/// Of each pixel, by the same rays as the ray caster's.
inline std::vector<double> ByMonteCarlo(
  const Setup& setup, const View& view, int paths, std::uint64_t seed, int threads)
{
  LitVolume volume;
  volume.size = setup.Grid().size;
  volume.spacing = setup.Grid().spacing;
  volume.sigma_t = fractal_cloud::Extinction(setup.edge, setup.thickness);
  volume.albedo = setup.albedo;
  volume.g = setup.g;
  volume.sunTravels = setup.SunTravels();
  volume.sunIrradiance = setup.sun;
  volume.skyRadiance = setup.sky;
  const tyndall::Camera camera = setup.CameraOf(view);
  const auto axes = tyndall::Axes(camera);
  const double half = std::tan(camera.viewAngle * 3.14159265358979323846 / 360.0);
  std::vector<ViewRay> rays;
  for (int j = 0; j < setup.imageSize[1]; ++j)
  {
    for (int i = 0; i < setup.imageSize[0]; ++i)
    {
      const double x = ((i + 0.5) / setup.imageSize[0] * 2.0 - 1.0) * half * setup.imageSize[0] / setup.imageSize[1];
      const double y = ((j + 0.5) / setup.imageSize[1] * 2.0 - 1.0) * half;
      ViewRay ray = { camera.position, axes[2] };
      double square = 0.0;
      for (int axis = 0; axis < 3; ++axis)
      {
        ray.along[axis] += x * axes[0][axis] + y * axes[1][axis];
        square += ray.along[axis] * ray.along[axis];
      }
      for (double& component : ray.along)
      {
        component /= std::sqrt(square);
      }
      rays.push_back(ray);
    }
  }
  return PictureByMonteCarlo(volume, rays, paths, seed, threads);
}

/// The cloud as a user has it: solved, then looked at.
class LitCloud
{
public:
  LitCloud(const Setup& how, const Method& method)
    : TheSetup(how)
  {
    for (const float sigma_t : fractal_cloud::Extinction(how.edge, how.thickness))
    {
      // The same transport coefficient, whatever g.
      const double scattered = sigma_t * how.albedo * (method.g == how.g ? 1.0 : (1.0 - how.g) / (1.0 - method.g));
      this->SigmaS.push_back(static_cast<float>(scattered));
      this->SigmaA.push_back(static_cast<float>(sigma_t * (1.0 - how.albedo)));
    }
    this->TheMedium.grid = how.Grid();
    this->TheMedium.sigma_s = { this->SigmaS.data(), 1 };
    this->TheMedium.sigma_a = { this->SigmaA.data(), 1 };
    this->TheMedium.phase = tyndall::PhaseFunction::HenyeyGreenstein(method.g);
    tyndall::Light sun;
    sun.direction = how.SunTravels();
    sun.power = { how.sun, how.sun, how.sun };
    this->Shining.lights = { sun };
    this->Shining.sky = { how.sky, how.sky, how.sky };
    this->settings.angularDegree = method.degree;
    this->settings.directionsPerFace = method.directionsPerFace;
  }
  LitCloud(const LitCloud&) = delete; // the medium sees arrays of its own

  tyndall::PropagationSettings settings;
  tyndall::ViewSettings view;

  void Solve(tyndall::Device& device)
  {
    this->settings.netFlux = this->settings.angularDegree == 0; // the ray caster then reads the mean direction
    this->Found = SolveConservative(device, this->TheMedium, this->Shining, this->settings);
  }
  const tyndall::LightField& Light() const { return this->Found; }

  /// Radiance of each pixel.
  std::vector<double> Picture(tyndall::Device& device, const View& from)
  {
    tyndall::SolvedLight light;
    light.fluence = { this->Found.fluence.data(), 1 };
    light.fluenceDirect = { this->Found.fluenceDirect.data(), 1 };
    const int voxels = static_cast<int>(this->TheMedium.grid.VoxelCount());
    if (!this->Found.scatteredMoments.empty())
    {
      light.scatteredMoments = { this->Found.scatteredMoments.data(),
        static_cast<int>(this->Found.scatteredMoments.size() / voxels) };
      light.straightOn = { this->Found.straightOn.data(), 1 };
      light.lampsApart = this->Found.lampsApart;
    }
    this->view.imageSize = this->TheSetup.imageSize;
    tyndall::MediumRayCaster caster(device, this->TheMedium, light, this->Shining, this->view);
    const tyndall::Picture picture = caster.Render(this->TheSetup.CameraOf(from));
    std::vector<double> radiance;
    for (std::size_t i = 0; i < picture.radiance.size(); i += 3)
    {
      radiance.push_back(picture.radiance[i]);
    }
    return radiance;
  }

private:
  Setup TheSetup;
  tyndall::Medium TheMedium;
  tyndall::Illumination Shining;
  std::vector<float> SigmaS, SigmaA;
  tyndall::LightField Found;
};

/// Relative to the mean of the picture.
struct Errors
{
  double rms;   ///< without the noise of Monte Carlo
  double mean;  ///< of the picture's mean, signed
  double noise; ///< of both halves together
};

/// @param first, second  independent pictures of the same expectation
inline Errors ErrorsOf(
  const std::vector<double>& picture, const std::vector<double>& first, const std::vector<double>& second)
{
  double square = 0.0, noise = 0.0, sum = 0.0, reference = 0.0;
  for (std::size_t i = 0; i < picture.size(); ++i)
  {
    square += (picture[i] - first[i]) * (picture[i] - second[i]);
    noise += 0.25 * (first[i] - second[i]) * (first[i] - second[i]);
    sum += picture[i];
    reference += 0.5 * (first[i] + second[i]);
  }
  const double count = static_cast<double>(picture.size()), mean = reference / count;
  return { std::sqrt(std::max(square, 0.0) / count) / mean, sum / reference - 1.0, std::sqrt(noise / count) / mean };
}
}
