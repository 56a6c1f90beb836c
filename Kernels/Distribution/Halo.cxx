#include "Distribution/Halo.h"

#include "Distribution/BoxExchange.h"

#include <algorithm>
#include <functional>

namespace tyndall
{
Halo::Halo(Communicator& communicator, const BlockPartition& partition, const std::array<bool, 3>& periodic, int layers)
  : Comm(communicator)
  , Partition(partition)
  , Around(periodic)
{
  const std::array<int, 3>& size = partition.whole.size;
  std::array<int, 3> most = {}; // largest number of periods away from the grid
  for (const VoxelBox& block : partition.blocks)
  {
    VoxelBox box = block;
    for (int axis = 0; axis < 3 && block.VoxelCount() > 0; ++axis)
    {
      const int first = block.first[axis] - layers, end = EndOf(block, axis) + layers;
      box.first[axis] = periodic[axis] ? first : std::max(0, first);
      box.size[axis] = (periodic[axis] ? end : std::min(size[axis], end)) - box.first[axis];
      most[axis] = periodic[axis] ? (layers + size[axis] - 1) / size[axis] : 0;
    }
    this->Boxes.push_back(box);
  }
  for (int z = -most[2]; z <= most[2]; ++z)
  {
    for (int y = -most[1]; y <= most[1]; ++y)
    {
      for (int x = -most[0]; x <= most[0]; ++x)
      {
        this->Periods.push_back({ x, y, z });
      }
    }
  }
}

/// The part of a box that lies `periods` grid periods away, as voxels of the grid.
VoxelBox Halo::Image(const VoxelBox& box, const std::array<int, 3>& periods) const
{
  VoxelBox moved = box;
  for (int axis = 0; axis < 3; ++axis)
  {
    moved.first[axis] -= periods[axis] * this->Partition.whole.size[axis];
  }
  return Common(moved, { { 0, 0, 0 }, this->Partition.whole.size });
}

Grid Halo::KnownGrid() const
{
  return BlockPartition{ this->Partition.whole, { this->Known() } }.OwnGrid(0);
}

/// Images of all ranks' known voxels.
std::vector<VoxelBox> Halo::Images(const std::array<int, 3>& periods) const
{
  std::vector<VoxelBox> images;
  for (const VoxelBox& box : this->Boxes)
  {
    images.push_back(this->Image(box, periods));
  }
  return images;
}

/// The box of known voxels that an image corresponds to.
VoxelBox Halo::PlaceOf(const VoxelBox& image, const std::array<int, 3>& periods) const
{
  VoxelBox place = image;
  for (int axis = 0; axis < 3; ++axis)
  {
    place.first[axis] += periods[axis] * this->Partition.whole.size[axis];
  }
  return place;
}

std::vector<float> Halo::Spread(const std::vector<float>& own, int components) const
{
  const VoxelBox& known = this->Known();
  std::vector<float> values(known.VoxelCount() * static_cast<std::size_t>(components));
  for (const std::array<int, 3>& periods : this->Periods)
  {
    const std::vector<VoxelBox> wanted = this->Images(periods);
    const std::vector<float> part = ValuesInBox(this->Comm, this->Partition, wanted, own, components);
    PutPart(part, values, known, this->PlaceOf(wanted[this->Comm.Rank()], periods), components);
  }
  return values;
}

std::vector<std::int64_t> Halo::Gather(const std::vector<std::int64_t>& known) const
{
  std::vector<std::int64_t> sums(this->Own().VoxelCount(), 0);
  for (const std::array<int, 3>& periods : this->Periods)
  {
    const std::vector<VoxelBox> found = this->Images(periods);
    const VoxelBox place = this->PlaceOf(found[this->Comm.Rank()], periods);
    const std::vector<std::int64_t> part =
      SumsInBlock(this->Comm, this->Partition, found, PartOf(known, this->Known(), place));
    std::transform(part.begin(), part.end(), sums.begin(), sums.begin(), std::plus<std::int64_t>());
  }
  return sums;
}

Field Halo::Spread(const Field& own, std::vector<float>& values) const
{
  if (!own.values)
  {
    return own;
  }
  const std::size_t count = this->Own().VoxelCount() * static_cast<std::size_t>(own.components);
  values = this->Spread(std::vector<float>(own.values, own.values + count), own.components);
  Field known = own;
  known.values = values.data();
  return known;
}
}
