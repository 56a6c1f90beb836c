#include "LatticeBoltzmann/Distributed/VoxelsAround.h"

#include "Distribution/BoxExchange.h"

#include <algorithm>

namespace tyndall
{
VoxelsAround::VoxelsAround(Communicator& communicator, const BlockPartition& partition, int layers)
  : Others(communicator)
  , Partition(partition)
{
  for (const VoxelBox& block : partition.blocks)
  {
    VoxelBox box = block;
    for (int axis = 0; axis < 3 && block.VoxelCount() > 0; ++axis)
    {
      box.first[axis] = std::max(0, block.first[axis] - layers);
      box.size[axis] = std::min(partition.whole.size[axis], EndOf(block, axis) + layers) - box.first[axis];
    }
    this->Boxes.push_back(box);
  }
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
    inner |= own.first[axis] > 0 ? 1 << (2 * axis) : 0;
    inner |= EndOf(own, axis) < this->Partition.whole.size[axis] ? 1 << (2 * axis + 1) : 0;
    own.first[axis] -= this->Known().first[axis];
  }
  return { this->KnownGrid(), own, inner };
}

std::vector<float> VoxelsAround::Spread(const std::vector<float>& own, int components) const
{
  return ValuesInBox(this->Others, this->Partition, this->Boxes, own, components);
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

MediumAround::MediumAround(const VoxelsAround& voxels, const Medium& own, const Field& ior)
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
}
}
