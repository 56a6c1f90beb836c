#include "TargetScenes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>

namespace bench
{
namespace
{
using namespace tyndall;

/// sigma_t times the longest edge at a place, in longest edges from the lower corner.
using Thickness = std::function<double(double, double, double)>;

/// A box whose longest edge is 1.
TargetScene Box(
  const std::string& name, std::array<int, 3> voxels, double size, double albedo, const Thickness& thickness)
{
  TargetScene scene;
  scene.name = name;
  Grid& grid = scene.medium.grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.size[axis] = std::max(4, static_cast<int>(size * voxels[axis]));
  }
  const double spacing = 1.0 / *std::max_element(grid.size.begin(), grid.size.end());
  grid.spacing = { spacing, spacing, spacing };
  for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
  {
    const std::array<int, 3> at = grid.VoxelAt(i);
    const double sigma_t = thickness((at[0] + 0.5) * spacing, (at[1] + 0.5) * spacing, (at[2] + 0.5) * spacing);
    scene.sigma_s.push_back(static_cast<float>(albedo * sigma_t));
    scene.sigma_a.push_back(static_cast<float>((1.0 - albedo) * sigma_t));
  }
  scene.medium.sigma_a = { scene.sigma_a.data(), 1 };
  scene.medium.sigma_s = { scene.sigma_s.data(), 1 };
  return scene;
}

/// Waves of wavelengths from the box's edge to a twentieth of it; variance 1, about.
Thickness Waves(unsigned seed)
{
  struct Wave
  {
    std::array<double, 3> k;
    double phase, height;
  };
  std::mt19937 random(seed);
  const auto unit = [&] { return random() / 4294967296.0; }; // the same with every library
  std::vector<Wave> waves;
  double squares = 0.0;
  for (int i = 0; i < 40; ++i)
  {
    const double k = 6.0 * std::pow(20.0, i / 40.0), cosine = 2.0 * unit() - 1.0,
                 turn = 2.0 * 3.14159265358979 * unit();
    const double sine = std::sqrt(1.0 - cosine * cosine), height = std::pow(k, -0.8);
    waves.push_back(
      { { k * sine * std::cos(turn), k * sine * std::sin(turn), k * cosine }, 6.28318530717959 * unit(), height });
    squares += 0.5 * height * height;
  }
  const double scale = 1.0 / std::sqrt(squares);
  return [=](double x, double y, double z) {
    double sum = 0.0;
    for (const Wave& wave : waves)
    {
      sum += scale * wave.height * std::sin(wave.k[0] * x + wave.k[1] * y + wave.k[2] * z + wave.phase);
    }
    return sum;
  };
}

Thickness LogNormal(double mean, double deviation, unsigned seed)
{
  const Thickness waves = Waves(seed);
  return [=](double x, double y, double z) {
    return mean * std::exp(deviation * waves(x, y, z) - 0.5 * deviation * deviation);
  };
}

void Emit(TargetScene& scene, double factor)
{
  for (const float sigma_a : scene.sigma_a)
  {
    scene.emission.push_back(static_cast<float>(factor * sigma_a));
  }
  scene.medium.emission = { scene.emission.data(), 1 };
}

void ShineAlong(TargetScene& scene, const std::array<double, 3>& direction)
{
  Light sun;
  sun.direction = direction;
  sun.power = { 1.0, 1.0, 1.0 };
  scene.light.lights.push_back(sun);
}

void AddLamp(TargetScene& scene, const std::array<double, 3>& place, double power)
{
  Light lamp;
  lamp.type = LightType::Point;
  lamp.position = place;
  lamp.power = { power, power, power };
  scene.light.lights.push_back(lamp);
}

/// The same with another thickness and albedo in each colour.
/// @param thickness  factors of the extinction
void Colour(TargetScene& scene, const std::array<double, 3>& thickness, const std::array<double, 3>& albedo)
{
  std::vector<float> sigma_a, sigma_s;
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    const double sigma_t = static_cast<double>(scene.sigma_a[i]) + scene.sigma_s[i];
    for (int c = 0; c < 3; ++c)
    {
      sigma_s.push_back(static_cast<float>(albedo[c] * thickness[c] * sigma_t));
      sigma_a.push_back(static_cast<float>((1.0 - albedo[c]) * thickness[c] * sigma_t));
    }
  }
  scene.sigma_a = std::move(sigma_a);
  scene.sigma_s = std::move(sigma_s);
  scene.medium.sigma_a = { scene.sigma_a.data(), 3 };
  scene.medium.sigma_s = { scene.sigma_s.data(), 3 };
}

Thickness Even(double tau)
{
  return [tau](double, double, double) { return tau; };
}

/// Inside or outside of a ball around the middle of a unit cube.
Thickness Ball(double radius, double inside, double outside)
{
  return [=](double x, double y, double z) {
    const double square = (x - 0.5) * (x - 0.5) + (y - 0.5) * (y - 0.5) + (z - 0.5) * (z - 0.5);
    return square < radius * radius ? inside : outside;
  };
}

/// Where waves are high there is a medium; the rest is empty.
Thickness Cloudlets(double tau, double level, unsigned seed)
{
  const Thickness waves = Waves(seed);
  return [=](double x, double y, double z) { return waves(x, y, z) > level ? tau : 0.0; };
}

void ShineFromSky(TargetScene& scene, double radiance)
{
  scene.light.sky = { radiance, radiance, radiance };
}

void ShineThroughFace(TargetScene& scene, int face)
{
  scene.light.faces[face] = { 1.0, 1.0, 1.0 };
}

void ScatterForwards(TargetScene& scene, double g)
{
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(g);
}

/// Media that are the same everywhere, from thin to thick.
void AddEvenScenes(std::vector<TargetScene>& scenes)
{
  const auto add = [&](const char* name, double tau, double albedo, double g) -> TargetScene& {
    scenes.push_back(Box(name, { 16, 16, 16 }, 1.0, albedo, Even(tau)));
    ScatterForwards(scenes.back(), g);
    return scenes.back();
  };
  ShineAlong(add("haze of tau 0.2, sun", 0.2, 0.95, 0.0), { 0.4, 0.2, -1.0 });
  TargetScene& hazy = add("haze of tau 0.5, g 0.85, sun and sky", 0.5, 0.99, 0.85);
  ShineAlong(hazy, { -0.7, 0.1, -0.5 });
  ShineFromSky(hazy, 0.1);
  ShineThroughFace(add("cube of tau 1.5, g 0.5, a face", 1.5, 0.9, 0.5), 2);
  ShineFromSky(add("cube of tau 3, albedo 0.5, sky", 3.0, 0.5, 0.0), 1.0);
  ShineThroughFace(add("cube of tau 8, albedo 0.99, a face", 8.0, 0.99, 0.0), 5);
  ShineAlong(add("cube of tau 25, albedo 0.999, sun", 25.0, 0.999, 0.0), { 0.1, 0.9, -0.6 });
  ShineFromSky(add("cube of tau 80, albedo 0.9, sky", 80.0, 0.9, 0.0), 1.0);
  AddLamp(add("lamp in fog of tau 2", 2.0, 0.9, 0.0), { 0.41, 0.57, 0.36 }, 1.0);
  AddLamp(add("lamp in tissue of tau 40, g 0.9", 40.0, 0.99, 0.9), { 0.53, 0.47, 0.61 }, 1.0);
}

void AddClouds(std::vector<TargetScene>& scenes)
{
  const auto add = [&](const char* name, double tau, double deviation, unsigned seed, double albedo,
                     double g) -> TargetScene& {
    scenes.push_back(Box(name, { 20, 16, 18 }, 1.0, albedo, LogNormal(tau, deviation, seed)));
    ScatterForwards(scenes.back(), g);
    return scenes.back();
  };
  ShineAlong(add("cloud of tau 5, sun", 5.0, 0.7, 101, 0.99, 0.0), { 0.5, -0.3, -0.8 });
  TargetScene& forward = add("cloud of tau 20, g 0.85, sun and sky", 20.0, 0.8, 102, 0.999, 0.85);
  ShineAlong(forward, { -0.2, -0.5, -0.9 });
  ShineFromSky(forward, 0.05);
  ShineFromSky(add("cloud of tau 60, g 0.9, sky", 60.0, 0.6, 103, 0.99, 0.9), 1.0);
  AddLamp(add("lamp in smoke of tau 10, albedo 0.7", 10.0, 0.9, 104, 0.7, 0.3), { 0.62, 0.31, 0.48 }, 1.0);
  TargetScene& lamps = add("two lamps in smoke of tau 6", 6.0, 0.5, 105, 0.85, 0.0);
  AddLamp(lamps, { 0.27, 0.52, 0.66 }, 1.0);
  AddLamp(lamps, { 0.71, 0.23, 0.24 }, 2.0);
  TargetScene& coloured = add("cloud in three colours, sun", 1.0, 0.7, 106, 0.9, 0.0);
  Colour(coloured, { 4.0, 8.0, 16.0 }, { 0.99, 0.95, 0.8 });
  ShineAlong(coloured, { 0.3, 0.6, -0.7 });
}

void AddPartlyEmptyScenes(std::vector<TargetScene>& scenes)
{
  const auto add = [&](const char* name, double albedo, double g, const Thickness& thickness) -> TargetScene& {
    scenes.push_back(Box(name, { 18, 18, 18 }, 1.0, albedo, thickness));
    ScatterForwards(scenes.back(), g);
    return scenes.back();
  };
  ShineAlong(add("ball in empty space, sun", 0.95, 0.0, Ball(0.34, 12.0, 0.0)), { 0.8, 0.3, -0.5 });
  ShineThroughFace(
    add("box half empty, g 0.6, a face", 0.98, 0.6, [](double, double, double z) { return z < 0.55 ? 15.0 : 0.0; }), 5);
  AddLamp(add("lamp in a hollow", 0.97, 0.0, Ball(0.22, 0.0, 12.0)), { 0.46, 0.55, 0.52 }, 1.0);
  TargetScene& cloudlets = add("cloudlets, g 0.85, sun and sky", 0.999, 0.85, Cloudlets(25.0, 0.6, 107));
  ShineAlong(cloudlets, { 0.2, 0.2, -1.0 });
  ShineFromSky(cloudlets, 0.1);
  Emit(add("plume that shines", 0.3, 0.0,
         [](double x, double y, double z) {
           return 10.0 * std::exp(-30.0 * ((x - 0.5) * (x - 0.5) + (y - 0.45) * (y - 0.45)) - 1.2 * z);
         }),
    1.0);
}

/// Voxels of other edges, and colours of tissue.
void AddStretchedScenes(std::vector<TargetScene>& scenes, bool cubes)
{
  const auto add = [&](const char* name, const std::array<double, 3>& edges, double albedo, double g,
                     const Thickness& thickness) -> TargetScene& {
    scenes.push_back(Box(name, { 16, 20, 12 }, 1.0, albedo, thickness));
    ScatterForwards(scenes.back(), g);
    for (int axis = 0; axis < 3 && !cubes; ++axis)
    {
      scenes.back().medium.grid.spacing[axis] *= edges[axis];
    }
    return scenes.back();
  };
  ShineFromSky(add("voxels 1:1:4, g 0.5, sky", { 1.0, 1.0, 4.0 }, 0.95, 0.5, LogNormal(5.0, 0.5, 108)), 1.0);
  AddLamp(add("voxels 1:3:1, lamp", { 1.0, 3.0, 1.0 }, 0.9, 0.0, Even(3.0)), { 0.37, 0.48, 0.29 }, 1.0);
  ShineAlong(
    add("voxels 4:1:2, cloud, sun", { 4.0, 1.0, 2.0 }, 0.99, 0.0, LogNormal(6.0, 0.7, 109)), { 0.4, -0.6, -0.7 });
  TargetScene& tissue = add("tissue in three colours, g 0.9, a face", { 1.0, 1.0, 1.0 }, 0.9, 0.9, Even(1.0));
  Colour(tissue, { 20.0, 40.0, 60.0 }, { 0.99, 0.95, 0.8 });
  ShineThroughFace(tissue, 4);
}
}

std::vector<TargetScene> TuningScenes(double size)
{
  std::vector<TargetScene> scenes;
  const auto even = [](double tau) { return [tau](double, double, double) { return tau; }; };
  const auto squares = [](double x, double y, double z, double w) { return x * x + y * y + z * z - w; };
  scenes.push_back(Box("thin cube, a face", { 40, 40, 40 }, size, 0.9, even(1.0)));
  scenes.back().light.faces[4] = { 1.0, 1.0, 1.0 };
  scenes.push_back(Box("cube of tau 5, a face", { 40, 40, 40 }, size, 0.9, even(5.0)));
  scenes.back().light.faces[4] = { 1.0, 1.0, 1.0 };
  scenes.push_back(Box("cube of tau 10, a face", { 40, 40, 40 }, size, 0.99, even(10.0)));
  scenes.back().light.faces[1] = { 1.0, 1.0, 1.0 };
  scenes.push_back(Box("cloud, sun and sky", { 48, 48, 48 }, size, 0.99, LogNormal(8.0, 1.0, 3)));
  scenes.back().light.sky = { 0.1, 0.1, 0.1 };
  ShineAlong(scenes.back(), { 0.3, 0.5, -1.0 });
  scenes.push_back(Box("fire ball", { 44, 44, 44 }, size, 0.3,
    [=](double x, double y, double z) { return 6.0 * std::exp(-8.0 * squares(x - 0.5, y - 0.5, z - 0.5, 0.0)); }));
  Emit(scenes.back(), 1.0);
  scenes.push_back(Box("lamp in fog", { 40, 40, 40 }, size, 0.8, even(4.0)));
  AddLamp(scenes.back(), { 0.325, 0.4, 0.63 }, 1.0);
  scenes.push_back(Box("ball in haze, sky", { 27, 20, 48 }, size, 0.9,
    [=](double x, double y, double z) { return squares(x - 0.29, y - 0.21, z - 0.5, 0.03) < 0.0 ? 30.0 : 0.4; }));
  scenes.back().light.sky = { 1.0, 1.0, 1.0 };
  return scenes;
}

std::vector<TargetScene> HeldOutScenes(double size)
{
  std::vector<TargetScene> scenes;
  scenes.push_back(Box("flat box, two faces", { 48, 48, 24 }, size, 0.95, [](double, double, double) { return 3.0; }));
  scenes.back().light.faces[5] = { 1.0, 1.0, 1.0 };
  scenes.back().light.faces[0] = { 0.3, 0.3, 0.3 };
  scenes.push_back(Box("blocks of contrast 100, a face", { 48, 36, 42 }, size, 0.95, [](double x, double y, double z) {
    return (static_cast<int>(8.0 * x) + static_cast<int>(8.0 * y) + static_cast<int>(8.0 * z)) % 2 ? 20.0 : 0.2;
  }));
  scenes.back().light.faces[2] = { 1.0, 1.0, 1.0 };
  scenes.push_back(Box("thick cloud, sun and sky", { 45, 45, 45 }, size, 0.999, LogNormal(20.0, 0.8, 11)));
  scenes.back().light.sky = { 0.2, 0.2, 0.2 };
  ShineAlong(scenes.back(), { -0.6, 0.2, -0.5 });
  const Thickness waves = Waves(5);
  scenes.push_back(Box("plume that shines", { 31, 27, 47 }, size, 0.3, [=](double x, double y, double z) {
    const double square = (x - 0.34) * (x - 0.34) + (y - 0.3) * (y - 0.3);
    return 8.0 * std::exp(-25.0 * square - 1.5 * z + 0.4 * waves(x, y, z));
  }));
  Emit(scenes.back(), 1.0);
  scenes.push_back(Box("two lamps in smoke", { 44, 44, 44 }, size, 0.85, LogNormal(6.0, 0.5, 23)));
  AddLamp(scenes.back(), { 0.26, 0.63, 0.33 }, 1.0);
  AddLamp(scenes.back(), { 0.81, 0.28, 1.2 }, 3.0);
  scenes.push_back(Box("cloud that scatters forwards", { 40, 40, 40 }, size, 0.98, LogNormal(6.0, 0.7, 41)));
  scenes.back().medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  scenes.back().light.sky = { 0.1, 0.1, 0.1 };
  ShineAlong(scenes.back(), { 0.2, -0.4, -1.0 });
  return scenes;
}

std::vector<TargetScene> CoverageScenes(bool cubes)
{
  std::vector<TargetScene> scenes;
  scenes.reserve(24);
  AddEvenScenes(scenes);
  AddClouds(scenes);
  AddPartlyEmptyScenes(scenes);
  AddStretchedScenes(scenes, cubes);
  return scenes;
}
}
