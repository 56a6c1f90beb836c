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
}
