#include "LightPropagation/Accuracy/CoarseSceneInBlocks.h"

#include <utility>

namespace tyndall
{
CoarseSceneInBlocks::CoarseSceneInBlocks(
  const CoarseBlocks& blocks, const Medium& medium, const Illumination& illumination)
  : Light(illumination)
{
  Medium fine = medium;
  if (blocks.Straddle() && blocks.Fine().blocks[blocks.Comm().Rank()].VoxelCount() > 0)
  {
    fine.grid = blocks.Own().Fine();
    for (Field* field : { &fine.sigma_a, &fine.sigma_s, &fine.emission, &this->Light.uncollided.fluence,
           &this->Light.uncollided.meanDirection })
    {
      *field = this->Around(blocks, *field);
    }
    if (medium.phase.Varies())
    {
      fine.phase = medium.phase.WithG(this->Around(blocks, medium.phase.G()));
    }
  }
  blocks.Comm().Collective([&] {
    if (blocks.HasOwn())
    {
      this->Coarse.emplace(fine, this->Light, blocks.Own());
    }
  });
  this->Arrays.clear();
  this->Light.uncollided.fluence = this->Light.uncollided.meanDirection = {};
}

/// Values of a field in all fine voxels that overlap the coarse voxels of this rank.
Field CoarseSceneInBlocks::Around(const CoarseBlocks& blocks, const Field& field)
{
  if (!field.values)
  {
    return field;
  }
  const std::size_t voxels = blocks.Fine().blocks[blocks.Comm().Rank()].VoxelCount();
  this->Arrays.push_back(blocks.Around(
    { field.values, field.values + voxels * static_cast<std::size_t>(field.components) }, field.components));
  Field around = field;
  around.values = this->Arrays.back().data();
  return around;
}
}
