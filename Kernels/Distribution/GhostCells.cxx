#include "Distribution/GhostCells.h"

#include "Distribution/BlockPartition.h"
#include "Distribution/MessageTags.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tyndall
{
namespace
{
/// Appends the indices of a part's cells in an array over a box.
void AddPlaces(const VoxelBox& box, const VoxelBox& part, std::vector<std::size_t>& places)
{
  for (int z = part.first[2]; z < EndOf(part, 2); ++z)
  {
    for (int y = part.first[1]; y < EndOf(part, 1); ++y)
    {
      const std::size_t row = static_cast<std::size_t>(z - box.first[2]) * box.size[1] + (y - box.first[1]);
      for (int x = part.first[0]; x < EndOf(part, 0); ++x)
      {
        places.push_back(row * box.size[0] + (x - box.first[0]));
      }
    }
  }
}

VoxelBox Moved(VoxelBox box, const std::array<int, 3>& by)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    box.first[axis] += by[axis];
  }
  return box;
}

/// Shift, in grid periods, that moves a box beyond the grid's ends into the grid.
std::array<int, 3> PeriodsOf(const VoxelBox& box, const std::array<int, 3>& gridSize)
{
  std::array<int, 3> by = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    by[axis] = box.first[axis] < 0 ? gridSize[axis] : box.first[axis] >= gridSize[axis] ? -gridSize[axis] : 0;
  }
  return by;
}
}

GhostCells::GhostCells(Communicator& communicator, const std::vector<VoxelBox>& own,
  const std::vector<std::vector<VoxelBox>>& ghosts, const VoxelBox& held, const std::array<int, 3>& gridSize)
  : Comm(communicator)
{
  const int self = communicator.Rank();
  const auto shared = [&](int owner, int holder, int other) {
    Shared cells = { other, {} };
    for (const VoxelBox& box : ghosts[holder])
    {
      const std::array<int, 3> round = PeriodsOf(box, gridSize);
      const VoxelBox common = Common(Moved(box, round), own[owner]);
      AddPlaces(held, holder == self ? Moved(common, { -round[0], -round[1], -round[2] }) : common, cells.places);
    }
    return cells;
  };
  for (int rank = 0; rank < communicator.Ranks(); ++rank)
  {
    if (rank == self)
    {
      continue;
    }
    if (Shared owned = shared(self, rank, rank); !owned.places.empty())
    {
      this->Owned.push_back(std::move(owned));
    }
    if (Shared copied = shared(rank, self, rank); !copied.places.empty())
    {
      this->Copied.push_back(std::move(copied));
    }
  }
}

template <class Value>
std::vector<Value> GhostCells::Exchange(const std::vector<Value>& owned, int arrays) const
{
  auto next = owned.begin();
  for (const Shared& cells : this->Owned)
  {
    const auto end = next + static_cast<std::ptrdiff_t>(arrays * cells.places.size());
    this->Comm.Send(cells.rank, MessageTag::GhostCells, std::vector<Value>(next, end));
    next = end;
  }
  std::vector<Value> copied;
  for (const Shared& cells : this->Copied)
  {
    const std::vector<Value> message = this->Comm.Receive<Value>(cells.rank, MessageTag::GhostCells);
    copied.insert(copied.end(), message.begin(), message.end());
  }
  return copied;
}

template std::vector<float> GhostCells::Exchange(const std::vector<float>&, int) const;

template <class Value>
void GhostCells::Fill(Value* values, int arrays, std::size_t stride) const
{
  std::vector<Value> owned;
  for (const Shared& cells : this->Owned)
  {
    for (int array = 0; array < arrays; ++array)
    {
      const Value* const from = values + array * stride;
      std::transform(cells.places.begin(), cells.places.end(), std::back_inserter(owned),
        [from](std::size_t place) { return from[place]; });
    }
  }
  const std::vector<Value> copied = this->Exchange(owned, arrays);
  auto next = copied.begin();
  for (const Shared& cells : this->Copied)
  {
    for (int array = 0; array < arrays; ++array)
    {
      for (const std::size_t place : cells.places)
      {
        values[array * stride + place] = *next++;
      }
    }
  }
}

template void GhostCells::Fill(double*, int, std::size_t) const;
template void GhostCells::Fill(float*, int, std::size_t) const;

std::vector<std::size_t> GhostCells::PlacesOf(const std::vector<Shared>& shared)
{
  std::vector<std::size_t> places;
  for (const Shared& cells : shared)
  {
    places.insert(places.end(), cells.places.begin(), cells.places.end());
  }
  return places;
}

std::array<bool, 3> GoesRoundAlone(
  const VoxelBox& own, const std::array<int, 3>& gridSize, const std::array<bool, 3>& periodic)
{
  std::array<bool, 3> alone = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    alone[axis] = periodic[axis] && own.size[axis] == gridSize[axis];
  }
  return alone;
}

std::vector<VoxelBox> LayersBeside(
  const VoxelBox& own, const std::array<int, 3>& gridSize, const std::array<bool, 3>& periodic)
{
  const std::array<bool, 3> alone = GoesRoundAlone(own, gridSize, periodic);
  std::vector<VoxelBox> layers;
  for (int face = 0; face < 6 && own.VoxelCount() > 0; ++face)
  {
    const int axis = face / 2;
    const int place = face % 2 ? EndOf(own, axis) : own.first[axis] - 1;
    if ((place >= 0 && place < gridSize[axis]) || (periodic[axis] && !alone[axis]))
    {
      layers.push_back(own);
      layers.back().first[axis] = place;
      layers.back().size[axis] = 1;
    }
  }
  return layers;
}

VoxelBox Hull(const VoxelBox& own, const std::vector<VoxelBox>& others)
{
  VoxelBox hull = own;
  for (const VoxelBox& other : others)
  {
    if (other.VoxelCount() == 0)
    {
      continue;
    }
    const VoxelBox before = hull;
    for (int axis = 0; axis < 3; ++axis)
    {
      const bool any = before.VoxelCount() > 0;
      const int end = any ? std::max(EndOf(before, axis), EndOf(other, axis)) : EndOf(other, axis);
      hull.first[axis] = any ? std::min(before.first[axis], other.first[axis]) : other.first[axis];
      hull.size[axis] = end - hull.first[axis];
    }
  }
  return hull;
}
}
