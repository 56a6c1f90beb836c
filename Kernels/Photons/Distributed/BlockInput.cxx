#include "Photons/Distributed/BlockInput.h"

#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"

#include <limits>
#include <string>
#include <vector>

namespace tyndall
{
VoxelBox BlockOf(const BlockPartition& partition, int rank)
{
  return rank < static_cast<int>(partition.blocks.size()) ? partition.blocks[rank] : VoxelBox();
}

void CheckMarchedBlock(const Communicator& communicator, const BlockPartition& partition, const Medium& medium,
  const Field& ior, const std::uint8_t* levels, bool octree)
{
  partition.Check();
  Require(static_cast<int>(partition.blocks.size()) == communicator.Ranks(), "There is not a block for each rank.");
  const VoxelBox& own = partition.blocks[communicator.Rank()];
  if (own.VoxelCount() == 0)
  {
    return;
  }
  const std::string rank = std::to_string(communicator.Rank());
  Check(medium);
  Require(medium.grid.size == own.size, "The medium of rank " + rank + " does not have the size of its block.");
  CheckIndex(ior, medium.grid);
  CheckLevels(levels, medium.grid, partition.whole);
  Require((levels != nullptr) == octree,
    "The block of rank " + rank +
      (levels ? " has octree levels and others have none." : " has no octree levels and others have."));
}

void RequireSameInput(
  Communicator& communicator, const BlockPartition& partition, const Medium& medium, const Field& ior)
{
  RequireSame(communicator, partition);
  const bool has = partition.blocks[communicator.Rank()].VoxelCount() > 0;
  RequireSame(communicator, "whether there is a refractive index", has, { ior.values ? 1.0 : 0.0 });
  const auto components = [](const Field& field) { return field.values ? field.components : 0; };
  RequireSame(communicator, "the components of sigma_a or sigma_s", has,
    { 1.0 * components(medium.sigma_a), 1.0 * components(medium.sigma_s) });
}

IndexRange IndexRangeOfAll(Communicator& communicator, bool has, const IndexRange& own)
{
  const float endless = std::numeric_limits<float>::infinity();
  const std::vector<double> largest =
    communicator.Largest({ has ? -own.least : -endless, has ? own.largest : -endless });
  return { static_cast<float>(-largest[0]), static_cast<float>(largest[1]) };
}
}
