#pragma once

#include "DeviceTest.h"
#include "Difference.h"
#include "Medium/Grid.h"

#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Viewing/MediumRayCaster.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <random>
#include <vector>

/// Scenes that tests look at, and what they measure in pictures.
namespace viewing
{
using Vec = std::array<double, 3>;
using namespace tyndall;

/// A medium that owns its arrays.
struct Scene
{
  Grid grid;
  std::vector<float> sigma_a, sigma_s, emission, fluence, fluenceDirect, meanDirection, ior, surface, moments,
    straightOn;
  std::vector<Light> lampsApart;
  int components = 1; ///< of sigma_a and sigma_s
  double g = 0.0;
  std::optional<PhaseOfMedium> phase; ///< instead of Henyey and Greenstein's of g
  Illumination illumination;
  ViewSettings settings;

  explicit Scene(const Grid& g = {})
    : grid(g)
  {
    this->settings.imageSize = { 61, 43 };
    this->settings.minimumTransmittance = 0.0;
  }

  std::vector<float> Everywhere(double value) const
  {
    return std::vector<float>(this->grid.VoxelCount(), static_cast<float>(value));
  }

  static Field See(const std::vector<float>& values, int components)
  {
    return { values.empty() ? nullptr : values.data(), components };
  }

  /// @param block  of which this is one
  MediumRayCaster Caster(Device& device, const BlockOfScene* block = nullptr) const
  {
    return { device, this->MediumSeen(), this->LightSeen(), this->illumination, this->settings, See(this->ior, 1),
      block };
  }

  Medium MediumSeen() const
  {
    Medium medium;
    medium.grid = this->grid;
    medium.sigma_a = See(this->sigma_a, this->components);
    medium.sigma_s = See(this->sigma_s, this->components);
    medium.emission = See(this->emission, 1);
    medium.phase = this->phase ? *this->phase : PhaseOfMedium(PhaseFunction::HenyeyGreenstein(this->g));
    return medium;
  }

  SolvedLight LightSeen() const
  {
    const auto channels = static_cast<int>(this->fluence.size() / std::max<std::size_t>(this->grid.VoxelCount(), 1));
    const auto cosines = static_cast<int>(this->surface.size() / BoxFaceCellCount(this->grid));
    const auto harmonics = static_cast<int>(this->moments.size() / std::max<std::size_t>(this->grid.VoxelCount(), 1));
    SolvedLight light = { See(this->fluence, std::max(channels, 1)), See(this->fluenceDirect, 1),
      See(this->meanDirection, 3), See(this->surface, cosines) };
    light.scatteredMoments = See(this->moments, harmonics);
    light.straightOn = See(this->straightOn, 1);
    light.lampsApart = this->lampsApart;
    return light;
  }

  double Aspect() const { return static_cast<double>(this->settings.imageSize[0]) / this->settings.imageSize[1]; }
  Camera Framed() const { return FrameGrid(this->grid, this->Aspect()); }
  Picture Seen(Device& device, const Camera& camera) const { return this->Caster(device).Render(camera); }
  Picture Seen(Device& device) const { return this->Seen(device, this->Framed()); }
};

/// On the average of pixels and channels.
inline double MeanDistance(const std::vector<float>& a, const std::vector<float>& b)
{
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i)
  {
    sum += std::abs(a[i] - b[i]);
  }
  return sum / a.size();
}

inline Grid GridOf(int nx, int ny, int nz, Vec spacing = { 1.0, 1.0, 1.0 }, Vec origin = { 0.0, 0.0, 0.0 })
{
  Grid grid;
  grid.size = { nx, ny, nz };
  grid.spacing = spacing;
  grid.origin = origin;
  return grid;
}

/// The ray through a pixel's centre, in double: where it starts, and its direction of unit length.
struct Ray
{
  Vec from, direction;
};

inline Ray RayThrough(const Camera& camera, const Picture& picture, int i, int j)
{
  const auto axes = Axes(camera);
  const double half = camera.parallelProjection ? camera.parallelScale : std::tan(camera.viewAngle * Pi / 360.0);
  const double x = ((i + 0.5) / picture.width * 2.0 - 1.0) * half * picture.width / picture.height;
  const double y = ((j + 0.5) / picture.height * 2.0 - 1.0) * half;
  Ray ray = { camera.position, axes[2] };
  for (int axis = 0; axis < 3; ++axis)
  {
    (camera.parallelProjection ? ray.from : ray.direction)[axis] += x * axes[0][axis] + y * axes[1][axis];
  }
  const double length = std::hypot(ray.direction[0], ray.direction[1], ray.direction[2]);
  for (double& component : ray.direction)
  {
    component /= length;
  }
  return ray;
}

/// Length of the ray's part in the grid's box.
inline double Chord(const Ray& ray, const Grid& grid)
{
  double in = 0.0;
  double out = 1e300;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double a = (grid.origin[axis] - ray.from[axis]) / ray.direction[axis];
    const double b = (grid.origin[axis] + grid.Length(axis) - ray.from[axis]) / ray.direction[axis];
    in = std::max(in, std::min(a, b));
    out = std::min(out, std::max(a, b));
  }
  return std::max(out - in, 0.0);
}

/// Calls check(pixel, ray) for every pixel.
template <class Check>
void ForEveryPixel(const Picture& picture, const Camera& camera, const Check& check)
{
  for (int j = 0; j < picture.height; ++j)
  {
    for (int i = 0; i < picture.width; ++i)
    {
      check(static_cast<std::size_t>(j) * picture.width + i, RayThrough(camera, picture, i, j));
    }
  }
}

inline std::vector<float> Random(std::size_t count, float largest, unsigned seed)
{
  std::mt19937 generator(seed);
  std::vector<float> values(count);
  for (float& value : values)
  {
    value = largest * static_cast<float>(generator() % 10000) / 10000.0f;
  }
  return values;
}

/// value(x, y, z) at the voxels' centres, in units of the box.
template <class Function>
std::vector<float> AtCentres(const Grid& grid, const Function& value)
{
  std::vector<float> values;
  values.reserve(grid.VoxelCount());
  ForGridVoxels(grid.size, [&](std::size_t, int i, int j, int k) {
    values.push_back(
      static_cast<float>(value((i + 0.5) / grid.size[0], (j + 0.5) / grid.size[1], (k + 0.5) / grid.size[2])));
  });
  return values;
}

/// Some blobs in a large void.
inline Scene Blobs()
{
  Scene scene(GridOf(50, 41, 37));
  scene.sigma_s = AtCentres(scene.grid, [](double x, double y, double z) {
    return std::max(0.0, std::sin(9.0 * x) * std::sin(8.0 * y) * std::sin(7.0 * z) - 0.6);
  });
  scene.sigma_a = scene.sigma_s;
  scene.fluence = Random(scene.grid.VoxelCount(), 5.0f, 3);
  scene.illumination.sky = { 0.2, 0.3, 0.4 };
  return scene;
}

inline Camera FromAbove(const Grid& grid, double height)
{
  Camera camera = FrameGrid(grid, 1.0, 30.0, { 0.0, 0.0, 1.0 }, { 0.0, 1.0, 0.0 });
  camera.position[2] = grid.origin[2] + grid.Length(2) + height;
  camera.parallelProjection = true;
  return camera;
}

inline std::size_t Middle(const Picture& picture)
{
  return static_cast<std::size_t>(picture.height / 2) * picture.width + picture.width / 2;
}

inline Environment SmoothEnvironment()
{
  Environment environment;
  environment.width = 32;
  environment.height = 16;
  for (int j = 0; j < 16; ++j)
  {
    for (int i = 0; i < 32; ++i)
    {
      const double azimuth = 2.0 * Pi * (i + 0.5) / 32;
      environment.radiance.push_back(static_cast<float>(2.0 + std::sin(azimuth)));
      environment.radiance.push_back(static_cast<float>(2.0 + std::cos(azimuth)));
      environment.radiance.push_back(static_cast<float>(1.0 + j));
    }
  }
  return environment;
}

/// Radiance (2 + x, 2 + y, 2 + z) from direction (x, y, z): a picture of it tells where each ray went.
inline Environment DirectionEnvironment()
{
  Environment environment;
  environment.width = 1024;
  environment.height = 512;
  for (int j = 0; j < environment.height; ++j)
  {
    for (int i = 0; i < environment.width; ++i)
    {
      const double polar = Pi * (1.0 - (j + 0.5) / environment.height);
      const double azimuth = 2.0 * Pi * (i + 0.5) / environment.width;
      environment.radiance.push_back(static_cast<float>(2.0 + std::sin(polar) * std::cos(azimuth)));
      environment.radiance.push_back(static_cast<float>(2.0 + std::sin(polar) * std::sin(azimuth)));
      environment.radiance.push_back(static_cast<float>(2.0 + std::cos(polar)));
    }
  }
  return environment;
}

/// The direction that a pixel of vacuum before that environment shows.
inline Vec SeenDirection(const Picture& picture, std::size_t pixel, double scale = 1.0)
{
  Vec direction;
  for (int c = 0; c < 3; ++c)
  {
    direction[c] = picture.radiance[3 * pixel + c] / scale - 2.0;
  }
  return direction;
}

inline double Dot(const Vec& a, const Vec& b)
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vec Unit(const Vec& v)
{
  const double length = std::sqrt(Dot(v, v));
  return { v[0] / length, v[1] / length, v[2] / length };
}

inline double Largest(const std::vector<float>& values)
{
  return *std::max_element(values.begin(), values.end());
}

/// Parallel rays along `direction`, the middle one through `target` (the grid's centre); the picture is 2 `half` high.
inline Camera Along(const Grid& grid, Vec direction, double half)
{
  direction = Unit(direction);
  const double distance = 2.0 * std::hypot(grid.Length(0), grid.Length(1), grid.Length(2));
  Camera camera;
  camera.parallelProjection = true;
  camera.parallelScale = half;
  camera.viewUp = std::abs(direction[2]) < 0.9 ? Vec{ 0.0, 0.0, 1.0 } : Vec{ 0.0, 1.0, 0.0 };
  for (int axis = 0; axis < 3; ++axis)
  {
    camera.focalPoint[axis] = grid.origin[axis] + 0.5 * grid.Length(axis);
    camera.position[axis] = camera.focalPoint[axis] - distance * direction[axis];
  }
  return camera;
}

/// n by squares, changing from n1 (above) to n2 (below) along z between heights `high` and `low` in voxels, as a
/// straight line that is rounded at its ends.
inline std::vector<float> Layers(const Grid& grid, double n1, double n2, double high, double low)
{
  return AtCentres(grid, [=](double, double, double z) {
    const double part = std::clamp((high - z * grid.size[2]) / (high - low), 0.0, 1.0);
    return std::sqrt(n1 * n1 + (n2 * n2 - n1 * n1) * part);
  });
}

/// A ball of glass about the box's centre, its radius in parts of the box's edge, its border smoothed over a few
/// voxels.
inline std::vector<float> Ball(const Grid& grid, double radius, double n)
{
  const double width = 1.5 / grid.size[0] * std::sqrt(2.0);
  return AtCentres(grid, [=](double x, double y, double z) {
    return 1.0 + (n - 1.0) * 0.5 * std::erfc((std::hypot(x - 0.5, y - 0.5, z - 0.5) - radius) / width);
  });
}

/// That packets of every width give one picture, to these differences of radiance and alpha.
inline void ExpectSameInPackets(Device& device, Scene scene, const Camera& camera, double radiance, double alpha)
{
  const Picture best = scene.Seen(device, camera);
  EXPECT_EQ(best.radiance, scene.Seen(device, camera).radiance);
  for (const int width : { 1, 4, 8, 16 })
  {
    scene.settings.packetWidth = width;
    const Picture picture = scene.Seen(device, camera);
    EXPECT_LT(LargestDifference(best.radiance, picture.radiance), radiance) << width;
    EXPECT_LT(LargestDifference(best.alpha, picture.alpha), alpha) << width;
    EXPECT_LT(LargestDifference(best.depth, picture.depth), 1e-3) << width;
  }
}

/// Mean errors of pictures by steps of this length and of a quarter of it, and the order of convergence from them.
struct StepConvergence
{
  StepConvergence(Device& device, Scene scene, const Camera& camera, double step)
  {
    const auto seenWith = [&](double length) {
      scene.settings.stepSize = length;
      return scene.Seen(device, camera).radiance;
    };
    const std::vector<float> exact = seenWith(0.0625);
    this->coarse = MeanDistance(exact, seenWith(step));
    this->fine = MeanDistance(exact, seenWith(0.25 * step));
    this->order = 0.5 * std::log2(this->coarse / this->fine);
    std::printf(
      "order of convergence %.2f, mean error at %g voxels a step %.2g\n", this->order, 0.25 * step, this->fine);
  }
  double coarse, fine, order;
};
}
