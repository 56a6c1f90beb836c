#pragma once

#include "ViewScene.h"

#include "Distribution/BoxExchange.h"
#include "Viewing/Scene/BlockOfScene.h"

/// Scenes that are spread over blocks.
namespace viewing
{
/// Blocks of a grid that is cut at these voxels of each axis.
inline std::vector<GridBlock> Cut(const Grid& whole, const std::array<std::vector<int>, 3>& cuts)
{
  std::array<std::vector<int>, 3> planes = cuts;
  for (int axis = 0; axis < 3; ++axis)
  {
    planes[axis].insert(planes[axis].begin(), 0);
    planes[axis].push_back(whole.size[axis]);
  }
  std::vector<GridBlock> blocks;
  for (std::size_t k = 1; k < planes[2].size(); ++k)
  {
    for (std::size_t j = 1; j < planes[1].size(); ++j)
    {
      for (std::size_t i = 1; i < planes[0].size(); ++i)
      {
        GridBlock block;
        block.whole = whole;
        block.begin = { planes[0][i - 1], planes[1][j - 1], planes[2][k - 1] };
        block.end = { planes[0][i], planes[1][j], planes[2][k] };
        block.showsBackgroundBeside = blocks.empty();
        for (int axis = 0; axis < 3; ++axis)
        {
          block.first[axis] = std::max(block.begin[axis] - 1, 0);
        }
        blocks.push_back(block);
      }
    }
  }
  return blocks;
}

/// Those of its voxels that are in a box; of its index those in another.
inline Scene PartOf(const Scene& scene, const GridBlock& block, const VoxelBox& held, const VoxelBox& known)
{
  Scene part = scene;
  part.grid.size = held.size;
  for (int axis = 0; axis < 3; ++axis)
  {
    part.grid.origin[axis] = block.whole.origin[axis] + held.first[axis] * block.whole.spacing[axis];
  }
  const auto crop = [&](std::vector<float> Scene::*field, const VoxelBox& box) {
    const std::vector<float>& from = scene.*field;
    const auto components = static_cast<int>(from.size() / scene.grid.VoxelCount());
    part.*field = components > 0 ? tyndall::PartOf(from, { {}, scene.grid.size }, box, components) : from;
  };
  for (std::vector<float> Scene::*field : { &Scene::sigma_a, &Scene::sigma_s, &Scene::emission, &Scene::fluence,
         &Scene::fluenceDirect, &Scene::meanDirection, &Scene::moments, &Scene::straightOn })
  {
    crop(field, held);
  }
  crop(&Scene::ior, known);
  if (!scene.surface.empty())
  {
    const auto cosines = static_cast<int>(SurfaceCosines.size());
    part.surface = FacesOfBlock(scene.surface, cosines, block, part.grid.size);
  }
  return part;
}

/// The voxels of a block and a layer of its neighbours.
inline Scene PartOf(const Scene& scene, const GridBlock& block)
{
  VoxelBox held = { block.first, {} };
  for (int axis = 0; axis < 3; ++axis)
  {
    held.size[axis] = std::min(block.end[axis] + 1, block.whole.size[axis]) - block.first[axis];
  }
  return PartOf(scene, block, held, held);
}

/// Uneven, coloured where that is asked for, with empty bricks.
inline Scene Cloud(int components)
{
  Scene scene(GridOf(27, 22, 19, { 0.5, 0.4, 0.6 }, { -3.0, 2.0, 1.0 }));
  std::mt19937 random(5);
  std::uniform_real_distribution<float> some(0.0f, 1.0f);
  scene.components = components;
  scene.settings.showBackground = false;
  for (std::size_t i = 0; i < components * scene.grid.VoxelCount(); ++i)
  {
    const bool empty = scene.grid.VoxelAt(i / components)[0] < 10;
    scene.sigma_a.push_back(empty ? 0.0f : 0.2f * some(random));
    scene.sigma_s.push_back(empty ? 0.0f : 0.5f * some(random));
    scene.fluence.push_back(some(random));
  }
  for (std::size_t i = 0; i < scene.grid.VoxelCount(); ++i)
  {
    scene.emission.push_back(scene.grid.VoxelAt(i)[0] < 10 ? 0.0f : 0.1f * some(random));
  }
  return scene;
}

}
