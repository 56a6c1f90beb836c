#include "LatticeBoltzmann/Distributed/VoxelsAround.h"

#include "Distribution/BoxExchange.h"

#include <algorithm>

namespace tyndall
{
VoxelsAround::VoxelsAround(
  Communicator& communicator, const BlockPartition& partition, const std::array<bool, 3>& periodic, int layers)
  : Others(communicator)
  , Partition(partition)
  , Periodic(periodic)
{
  const std::array<int, 3>& size = partition.whole.size;
  std::array<int, 3> most = {}; // periods away from the grid
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

/// Of a box the part that is so many periods away, as voxels of the grid.
VoxelBox VoxelsAround::Image(const VoxelBox& box, const std::array<int, 3>& periods) const
{
  VoxelBox moved = box;
  for (int axis = 0; axis < 3; ++axis)
  {
    moved.first[axis] -= periods[axis] * this->Partition.whole.size[axis];
  }
  return Common(moved, { { 0, 0, 0 }, this->Partition.whole.size });
}

Grid VoxelsAround::KnownGrid() const
{
  return BlockPartition{ this->Partition.whole, { this->Known() } }.OwnGrid(0);
}

LatticeBox VoxelsAround::Box() const
{
  VoxelBox own = this->Own();
  int inner = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    const bool around = this->Periodic[axis];
    inner |= around || own.first[axis] > 0 ? 1 << (2 * axis) : 0;
    inner |= around || EndOf(own, axis) < this->Partition.whole.size[axis] ? 1 << (2 * axis + 1) : 0;
    own.first[axis] -= this->Known().first[axis];
  }
  return { this->KnownGrid(), own, inner };
}

std::vector<float> VoxelsAround::Spread(const std::vector<float>& own, int components) const
{
  const VoxelBox& known = this->Known();
  std::vector<float> values(known.VoxelCount() * static_cast<std::size_t>(components));
  for (const std::array<int, 3>& periods : this->Periods)
  {
    std::vector<VoxelBox> wanted;
    for (const VoxelBox& box : this->Boxes)
    {
      wanted.push_back(this->Image(box, periods));
    }
    const std::vector<float> part = ValuesInBox(this->Others, this->Partition, wanted, own, components);
    VoxelBox place = wanted[this->Others.Rank()];
    for (int axis = 0; axis < 3; ++axis)
    {
      place.first[axis] += periods[axis] * this->Partition.whole.size[axis];
    }
    PutPart(part, values, known, place, components);
  }
  return values;
}

Field VoxelsAround::Spread(const Field& own, std::vector<float>& values) const
{
  if (!own.values)
  {
    return own;
  }
  const std::size_t count = this->Own().VoxelCount() * static_cast<std::size_t>(own.components);
  values = this->Spread(std::vector<float>(own.values, own.values + count), own.components);
  return { values.data(), own.components };
}

MediumAround::MediumAround(
  const VoxelsAround& voxels, const Medium& own, const Field& ior, const UncollidedImage& image)
  : medium(own)
{
  this->medium.grid = voxels.KnownGrid();
  this->medium.sigma_a = voxels.Spread(own.sigma_a, this->Absorption);
  this->medium.sigma_s = voxels.Spread(own.sigma_s, this->Scattering);
  this->medium.emission = voxels.Spread(own.emission, this->Emission);
  if (own.phase.Varies())
  {
    this->medium.phase = own.phase.WithG(voxels.Spread(own.phase.G(), this->G));
  }
  this->index = voxels.Spread(ior, this->Index);
  this->uncollided = image;
  this->uncollided.fluence = voxels.Spread(image.fluence, this->Fluence);
  this->uncollided.meanDirection = voxels.Spread(image.meanDirection, this->Directions);
}
}
