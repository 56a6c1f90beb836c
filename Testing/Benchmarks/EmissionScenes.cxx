#include "EmissionScenes.h"

#include "Numerics/Constants.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace bench
{
namespace
{
using namespace tyndall;

/// A cube of edge 1 and optical thickness tau, in which a cube of voxels shines from `first` on.
EmissionScene Cube(const std::string& name, int edge, double tau, int first, int shining, int channels = 1)
{
  const double h = 1.0 / edge;
  EmissionScene scene(name, { edge, edge, edge }, { h, h, h }, channels);
  std::fill(scene.sigma_a.begin(), scene.sigma_a.end(), static_cast<float>(tau));
  scene.sourceFirst = { first, first, first };
  scene.sourceSize = { shining, shining, shining };
  for (int i = 0; i < shining * shining * shining; ++i)
  {
    const std::size_t voxel = scene.medium.grid.IndexOf(
      { first + i % shining, first + i / shining % shining, first + i / (shining * shining) });
    for (int c = 0; c < channels; ++c)
    {
      scene.emission[voxel * channels + c] = channels == 1 || i % channels == c ? 1.0f : 0.0f;
    }
  }
  return scene;
}

/// Extinction by chance, spread evenly over two decades.
EmissionScene ByChance(const std::string& name, int edge, double tau)
{
  EmissionScene scene = Cube(name, edge, 0.0, edge / 2, 1);
  std::mt19937 random(20261125);
  std::uniform_real_distribution<double> exponent(-2.0, 0.0);
  const double mean = 0.99 / (2.0 * std::log(10.0)); // of 10^exponent
  for (float& sigma : scene.sigma_a)
  {
    sigma = static_cast<float>(tau * std::pow(10.0, exponent(random)) / mean);
  }
  return scene;
}

/// Kobayashi's problems in cm, mirrored at the three planes that reflect: a source of 20 cm in a duct through a shield.
/// @param isVoid  of a point's distances from those planes
EmissionScene Duct(const std::string& name, bool (*isVoid)(const std::array<double, 3>& at))
{
  EmissionScene scene(name, { 60, 100, 60 }, { 2.0, 2.0, 2.0 }, 1);
  Grid& grid = scene.medium.grid;
  for (std::size_t i = 0; i < grid.VoxelCount(); ++i)
  {
    std::array<double, 3> at;
    for (int a = 0; a < 3; ++a)
    {
      at[a] = std::abs(2.0 * (grid.VoxelAt(i)[a] + 0.5) - grid.size[a]);
    }
    const bool shines = std::max({ at[0], at[1], at[2] }) < 10.0;
    scene.sigma_a[i] = !shines && isVoid(at) ? 1e-4f : 0.1f;
    scene.emission[i] = shines ? static_cast<float>(0.25 / Pi) : 0.0f;
  }
  scene.sourceFirst = { 25, 45, 25 };
  scene.sourceSize = { 10, 10, 10 };
  scene.error = 0.005;
  return scene;
}

bool IsInStraightDuct(const std::array<double, 3>& at)
{
  return at[0] < 10.0 && at[2] < 10.0;
}

bool IsInBentDuct(const std::array<double, 3>& at)
{
  const bool first = at[0] < 10.0 && at[1] < 60.0 && at[2] < 10.0;
  const bool second = at[0] < 40.0 && at[1] > 50.0 && at[1] < 60.0 && at[2] < 10.0;
  const bool third = at[0] > 30.0 && at[0] < 40.0 && at[1] > 50.0 && at[1] < 60.0 && at[2] < 40.0;
  const bool last = at[0] > 30.0 && at[0] < 40.0 && at[1] > 50.0 && at[2] > 30.0 && at[2] < 40.0;
  return first || second || third || last;
}
}

EmissionScene::EmissionScene(
  const std::string& itsName, std::array<int, 3> size, std::array<double, 3> spacing, int channels)
  : name(itsName)
{
  this->medium.grid.size = size;
  this->medium.grid.spacing = spacing;
  const std::size_t voxels = this->medium.grid.VoxelCount();
  this->sigma_a.assign(voxels, 0.0f);
  this->sigma_s.assign(voxels, 0.0f);
  this->emission.assign(voxels * channels, 0.0f);
  this->medium.sigma_a = { this->sigma_a.data(), 1 };
  this->medium.sigma_s = { this->sigma_s.data(), 1 };
  this->medium.emission = { this->emission.data(), channels };
}

std::vector<EmissionScene> EmissionScenes(int edge)
{
  std::vector<EmissionScene> scenes;
  scenes.push_back(Cube("one voxel, tau 2", edge, 2.0, edge / 2, 1));
  scenes.push_back(Cube("in a corner, tau 2", edge, 2.0, 0, 1));
  scenes.push_back(Cube("12 voxels wide, tau 2", edge, 2.0, edge / 2 - 6, 12));
  scenes.push_back(ByChance("by chance, tau 1", edge, 1.0));
  scenes.push_back(ByChance("by chance, tau 10", edge, 10.0));
  scenes.push_back(Cube("three colours, tau 2", edge, 2.0, edge / 2 - 1, 3, 3));
  scenes.push_back(Duct("Kobayashi 2", IsInStraightDuct));
  scenes.push_back(Duct("Kobayashi 3", IsInBentDuct));
  return scenes;
}
}
