#include "Propagation/PreviewLight.h"

#include "Device/HostThreads.h"
#include "LightPropagation/Problem/CoarseScene.h"
#include "Medium/Coarsening.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// Half as many voxels along each axis, and half of those while more than PreviewVoxels are left.
/// @param may  whether a grid is one to be halved
template <class May>
Grid Halved(Grid grid, const May& may)
{
  for (bool first = true; may(grid) && (first || grid.VoxelCount() > PreviewVoxels); first = false)
  {
    grid = Coarsening(grid).Coarse();
  }
  return grid;
}

std::string SizeOf(const Grid& grid)
{
  return std::to_string(grid.size[0]) + " x " + std::to_string(grid.size[1]) + " x " + std::to_string(grid.size[2]);
}

/// Of each voxel along an axis: its value is (1 - part) of the coarse voxel `first` and part of `second`.
struct Between
{
  std::size_t first, second;
  float part;
};

std::vector<Between> BetweenAlong(int axis, const Coarsening& coarsening)
{
  const int fine = coarsening.Fine().size[axis], coarse = coarsening.Coarse().size[axis];
  std::vector<Between> places(static_cast<std::size_t>(fine));
  for (int i = 0; i < fine; ++i)
  {
    const double place = std::clamp((i + 0.5) * coarse / fine - 0.5, 0.0, coarse - 1.0);
    const int first = static_cast<int>(place);
    places[i] = { static_cast<std::size_t>(first), static_cast<std::size_t>(std::min(first + 1, coarse - 1)),
      static_cast<float>(place - first) };
  }
  return places;
}

float Mix(float first, float second, float part)
{
  return first + part * (second - first);
}

/// The coarse values of a row along x, between those of four coarse rows.
void MixRows(
  const std::vector<float>& values, const Grid& coarse, const Between& y, const Between& z, std::vector<float>& row)
{
  const std::size_t layer = row.size() * static_cast<std::size_t>(coarse.size[1]);
  const float* const low = values.data() + z.first * layer;
  const float* const high = values.data() + z.second * layer;
  const std::size_t near = y.first * row.size(), far = y.second * row.size();
  for (std::size_t i = 0; i < row.size(); ++i)
  {
    row[i] = Mix(Mix(low[near + i], low[far + i], y.part), Mix(high[near + i], high[far + i], y.part), z.part);
  }
}

/// Values of the coarse voxels, linear between their middles, at those of the fine ones.
std::vector<float> Refined(const std::vector<float>& values, int channels, const Coarsening& coarsening)
{
  const auto xs = BetweenAlong(0, coarsening), ys = BetweenAlong(1, coarsening), zs = BetweenAlong(2, coarsening);
  const auto c = static_cast<std::size_t>(channels);
  std::vector<float> refined(coarsening.Fine().VoxelCount() * c);
  InThreads(ys.size() * zs.size(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<float> row(static_cast<std::size_t>(coarsening.Coarse().size[0]) * c);
    for (std::size_t line = begin; line < end; ++line)
    {
      MixRows(values, coarsening.Coarse(), ys[line % ys.size()], zs[line / ys.size()], row);
      float* out = refined.data() + line * xs.size() * c;
      for (const Between& x : xs)
      {
        for (std::size_t channel = 0; channel < c; ++channel)
        {
          *out++ = Mix(row[x.first * c + channel], row[x.second * c + channel], x.part);
        }
      }
    }
  });
  return refined;
}
}

Grid PreviewGrid(const Grid& grid)
{
  return Halved(grid, [](const Grid&) { return true; });
}

Grid CubicPreviewGrid(const Grid& grid)
{
  return Halved(grid, [](const Grid& halved) {
    return std::all_of(halved.size.begin(), halved.size.end(), [](int voxels) { return voxels % 2 == 0; });
  });
}

LightField SolvePreview(
  const Medium& medium, const Illumination& illumination, const Grid& coarse, const SolveIn& solve)
{
  const Coarsening coarsening(medium.grid, coarse);
  const CoarseScene scene(medium, illumination, coarsening);
  LightField found = solve(scene.TheMedium(), scene.Shining());
  LightField light;
  light.channels = found.channels;
  light.fluence = Refined(found.fluence, found.channels, coarsening);
  if (!found.fluenceDirect.empty())
  {
    light.fluenceDirect = Refined(found.fluenceDirect, found.channels, coarsening);
  }
  light.balance = found.balance;
  light.facePowerOut = found.facePowerOut;
  light.halfRangeFlux = found.halfRangeFlux;
  light.convergence = std::move(found.convergence);
  light.sweepsSaved = std::move(found.sweepsSaved);
  light.device = std::move(found.device);
  light.leftOut = std::move(found.leftOut);
  light.leftOut.insert(light.leftOut.begin(),
    "detail: a preview, of " + SizeOf(coarse) + " of " + SizeOf(medium.grid) + " voxels, few directions");
  return light;
}
}
