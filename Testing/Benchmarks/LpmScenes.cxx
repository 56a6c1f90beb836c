#include "LpmScenes.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <random>
#include <stdexcept>

namespace bench
{
namespace
{
using namespace tyndall;

constexpr float Albedo[3] = { 0.95f, 0.9f, 0.8f };
constexpr std::size_t HeaderBytes = 256;

/// @param sigma_t  1/length
Scene SceneOf(const std::string& name, const Grid& grid, const std::vector<float>& sigma_t, int channels)
{
  Scene scene;
  scene.name = name + (channels == 3 ? ", RGB" : ", grey");
  scene.channels = channels;
  scene.medium.grid = grid;
  for (const float extinction : sigma_t)
  {
    for (int c = 0; c < channels; ++c)
    {
      scene.sigma_s.push_back(extinction * Albedo[channels == 3 ? c : 1]);
      scene.sigma_a.push_back(extinction - scene.sigma_s.back());
    }
  }
  scene.medium.sigma_a = { scene.sigma_a.data(), channels };
  scene.medium.sigma_s = { scene.sigma_s.data(), channels };
  scene.light.sky = channels == 3 ? Rgb{ 0.8, 1.0, 1.3 } : Rgb{ 1.0, 1.0, 1.0 };
  return scene;
}

/// The number after `key` in an INRIMAGE header, e.g. "XDIM=64"; 0 if it is not there.
double HeaderNumber(const std::string& header, const std::string& key)
{
  const std::size_t at = header.find("\n" + key + "=");
  return at == std::string::npos ? 0.0 : std::atof(header.c_str() + at + key.size() + 2);
}

/// The voxels' grid, with its longest edge made 1.
Grid ReadHeader(const std::string& header, const std::string& file)
{
  Grid grid;
  double longest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::string letter(1, "XYZ"[axis]);
    grid.size[axis] = static_cast<int>(HeaderNumber(header, letter + "DIM"));
    grid.spacing[axis] = HeaderNumber(header, "V" + letter);
    longest = std::max(longest, grid.Length(axis));
  }
  const bool floats = header.find("\nTYPE=float") != std::string::npos && HeaderNumber(header, "PIXSIZE") == 32.0 &&
    HeaderNumber(header, "VDIM") == 1.0 && header.find("\nCPU=decm") != std::string::npos;
  const bool sized = *std::min_element(grid.size.begin(), grid.size.end()) >= 1 &&
    *std::min_element(grid.spacing.begin(), grid.spacing.end()) > 0.0;
  if (header.compare(0, 10, "#INRIMAGE-") != 0 || !floats || !sized)
  {
    throw std::runtime_error(file + " does not begin with the header of an INRIMAGE of little-endian floats");
  }
  for (double& spacing : grid.spacing)
  {
    spacing /= longest;
  }
  return grid;
}
}

std::string Scene::GridName() const
{
  const std::array<int, 3>& size = this->medium.grid.size;
  return std::to_string(size[0]) + "x" + std::to_string(size[1]) + "x" + std::to_string(size[2]);
}

Scene RandomScene(int edge, int channels)
{
  constexpr float thickness = 8.0f;
  std::mt19937 random(1);
  std::vector<float> sigma_t(static_cast<std::size_t>(edge) * edge * edge);
  const auto unit = [&] { return static_cast<float>(random()) / 4294967296.0f; }; // the same with every library
  for (float& value : sigma_t)
  {
    const bool empty = unit() < 0.1f;
    value = empty ? 0.0f : 2.0f * thickness / 0.9f * unit();
  }
  return SceneOf("random", { { edge, edge, edge }, { 1.0 / edge, 1.0 / edge, 1.0 / edge } }, sigma_t, channels);
}

Scene ScanScene(const std::string& file, int channels)
{
  constexpr float thickest = 100.0f;
  std::ifstream in(file, std::ios::binary);
  std::string header(HeaderBytes, '\0');
  if (!in.read(header.data(), HeaderBytes))
  {
    throw std::runtime_error(file + " cannot be read");
  }
  const Grid grid = ReadHeader(header, file);
  std::vector<float> values(grid.VoxelCount());
  if (!in.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(values.size() * sizeof(float))))
  {
    throw std::runtime_error(file + " is too short for its header");
  }
  const float largest = *std::max_element(values.begin(), values.end());
  for (float& value : values)
  {
    value = thickest * std::max(0.0f, value) / largest;
  }
  return SceneOf("CT scan", grid, values, channels);
}
}
