#include "Distribution/Rounds.h"

#include <algorithm>
#include <stdexcept>

namespace tyndall
{
Rounds::Rounds(
  Communicator& communicator, const BlockPartition& partition, int reach, const std::array<bool, 3>& periodic)
  : Comm(communicator)
  , Partition(partition)
  , Neighbours(NeighboursOf(partition, communicator.Rank(), reach, periodic))
{
}

std::size_t Rounds::NeighbourWith(const int* voxel) const
{
  const auto holds = [&](int rank) { return Holds(this->Partition.blocks[static_cast<std::size_t>(rank)], voxel); };
  const auto to = std::find_if(this->Neighbours.begin(), this->Neighbours.end(), holds);
  if (to == this->Neighbours.end())
  {
    throw std::logic_error("Light has left a block into one that does not touch it.");
  }
  return static_cast<std::size_t>(to - this->Neighbours.begin());
}
}
