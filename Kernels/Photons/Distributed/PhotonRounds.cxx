#include "Photons/Distributed/PhotonRounds.h"

#include <algorithm>
#include <stdexcept>

namespace tyndall
{
VoxelBox Grown(VoxelBox box, int by, const Grid& whole)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const int end = std::min(EndOf(box, axis) + by, whole.size[axis]);
    box.first[axis] = std::max(box.first[axis] - by, 0);
    box.size[axis] = end - box.first[axis];
  }
  return box;
}

bool Holds(const VoxelBox& box, const int* voxel)
{
  bool holds = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    holds = holds && voxel[axis] >= box.first[axis] && voxel[axis] < EndOf(box, axis);
  }
  return holds;
}

PhotonRounds::PhotonRounds(Communicator& communicator, const BlockPartition& partition)
  : Others(communicator)
  , Partition(partition)
{
  const int self = communicator.Rank();
  const VoxelBox touched = Grown(partition.blocks.at(static_cast<std::size_t>(self)), 1, partition.whole);
  const bool has = partition.blocks[static_cast<std::size_t>(self)].VoxelCount() > 0;
  for (int rank = 0; rank < static_cast<int>(partition.blocks.size()) && has; ++rank)
  {
    if (rank != self && Common(partition.blocks[static_cast<std::size_t>(rank)], touched).VoxelCount() > 0)
    {
      this->Neighbours.push_back(rank);
    }
  }
}

std::size_t PhotonRounds::NeighbourWith(const int* voxel) const
{
  const auto holds = [&](int rank) { return Holds(this->Partition.blocks[static_cast<std::size_t>(rank)], voxel); };
  const auto to = std::find_if(this->Neighbours.begin(), this->Neighbours.end(), holds);
  if (to == this->Neighbours.end())
  {
    throw std::logic_error("A photon has left its block into one that does not touch it.");
  }
  return static_cast<std::size_t>(to - this->Neighbours.begin());
}
}
