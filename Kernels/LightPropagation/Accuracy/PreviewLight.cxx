#include "LightPropagation/Accuracy/PreviewLight.h"

#include "Distribution/SharedMedium.h"
#include "LightPropagation/Accuracy/CoarseSceneInBlocks.h"
#include "LightPropagation/Accuracy/SceneOnFirst.h"
#include "LightPropagation/Distributed/BlockScene.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// Halves the number of voxels along each axis once, and again while more than PreviewVoxels are left.
/// @param may  whether a grid may be halved
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

void RequireSame(const SceneInBlocks& own, const Field& index, const PropagationSettings& alike)
{
  const bool has = own.partition.blocks.at(own.others.Rank()).VoxelCount() > 0;
  RequireSame(own.others, own.partition);
  RequireSame(own.others, has, own.medium, own.illumination, alike);
  RequireSame(own.others, "whether there is a refractive index", has, { index.values ? 1.0 : 0.0 });
}

/// A decomposed scene on its coarse grid, this rank's part.
class CoarseOfPreview
{
public:
  CoarseOfPreview(const CoarseBlocks& blocks, const SceneInBlocks& own, const Field& index)
    : Scene(blocks, own.medium, own.illumination)
  {
    if (OnAnyRank(own.others, index.values != nullptr))
    {
      const std::size_t voxels = own.partition.blocks[own.others.Rank()].VoxelCount();
      this->Index = blocks.Average({ index.values, index.values + (index.values ? voxels : 0) }, 1);
    }
  }

  PreviewScene Own() const
  {
    return { this->Scene.TheMedium(), this->Scene.Shining(),
      { this->Index.empty() ? nullptr : this->Index.data(), 1 } };
  }

private:
  CoarseSceneInBlocks Scene;
  std::vector<float> Index;
};

/// Interpolates light from the coarse grid to this rank's voxels.
LightField Shown(LightField&& found, const CoarseBlocks& blocks)
{
  LightField light;
  light.channels = found.channels;
  light.fluence = blocks.Seen().Refine(blocks.SeenOf(found.fluence, found.channels), found.channels);
  if (OnAnyRank(blocks.Comm(), !found.fluenceDirect.empty()))
  {
    light.fluenceDirect = blocks.Seen().Refine(blocks.SeenOf(found.fluenceDirect, found.channels), found.channels);
  }
  light.balance = found.balance;
  light.facePowerOut = found.facePowerOut;
  light.halfRangeFlux = found.halfRangeFlux;
  light.directionsPerFace = found.directionsPerFace;
  light.uncollidedDirections = found.uncollidedDirections;
  light.polarNodes = found.polarNodes;
  light.convergence = std::move(found.convergence);
  light.sweepsSaved = std::move(found.sweepsSaved);
  light.device = std::move(found.device);
  light.leftOut = std::move(found.leftOut);
  light.leftOut.insert(light.leftOut.begin(),
    "detail: a preview, of " + SizeOf(blocks.Coarse().whole) + " of " + SizeOf(blocks.Fine().whole) +
      " voxels, few directions");
  return light;
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

LightField SolvePreview(const PreviewScene& scene, const Grid& coarse, const PreviewSolver& solve)
{
  SingleRank alone;
  const BlockPartition whole = BlockPartition::Even(scene.medium.grid, 1);
  const CoarseBlocks blocks(alone, whole, coarse);
  const CoarseOfPreview averages(blocks, { alone, whole, scene.medium, scene.illumination }, scene.index);
  return Shown(solve(averages.Own()), blocks);
}

LightField SolvePreviewOnFirst(const SceneInBlocks& own, const Field& index, const PropagationSettings& alike,
  const Grid& coarse, const PreviewSolver& solve)
{
  RequireSame(own, index, alike);
  const CoarseBlocks blocks(own.others, own.partition, coarse);
  const CoarseOfPreview averages(blocks, own, index);
  const SceneOnFirst first(blocks, averages.Own(), own.medium);
  LightField found;
  own.others.Collective([&] {
    if (first.IsHere())
    {
      found = solve(first.Whole());
    }
  });
  first.Spread(found);
  return Shown(std::move(found), blocks);
}

LightField SolvePreviewInBlocks(const SceneInBlocks& own, const Field& index, const PropagationSettings& alike,
  const Grid& coarse, const PreviewSolverInBlocks& solve)
{
  RequireSame(own, index, alike);
  const CoarseBlocks blocks(own.others, own.partition, coarse);
  const CoarseOfPreview averages(blocks, own, index);
  return Shown(solve(averages.Own(), blocks.Coarse()), blocks);
}
}
