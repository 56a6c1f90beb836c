#include "Distribution/Halo.h"

#include "Distribution/BoxExchange.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
/// Appends the indices, in an array over the box `box`, of the cells in the box `part`.
void AddPlaces(const VoxelBox& box, const VoxelBox& part, std::vector<std::size_t>& places)
{
  ForRows(part, box, [&](std::size_t place, const auto&) {
    for (int x = 0; x < part.size[0]; ++x)
    {
      places.push_back(place + x);
    }
  });
}

VoxelBox Moved(VoxelBox box, const std::array<int, 3>& by, int factor = 1)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    box.first[axis] += factor * by[axis];
  }
  return box;
}

/// Shift in cells, a multiple of the grid's size along each axis, that moves the first cell of a box into the grid.
std::array<int, 3> ShiftOf(const VoxelBox& box, const std::array<int, 3>& gridSize)
{
  std::array<int, 3> by = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    const int size = gridSize[axis], first = box.first[axis];
    by[axis] = size > 0 ? -(first < 0 ? first - size + 1 : first) / size * size : 0;
  }
  return by;
}

/// The block with its halo, in voxels of the whole grid; empty if the block is empty.
VoxelBox WithHalo(const VoxelBox& block, const Grid& whole, const std::array<bool, 3>& periodic, int layers)
{
  VoxelBox box = block;
  for (int axis = 0; axis < 3 && block.VoxelCount() > 0; ++axis)
  {
    const int first = block.first[axis] - layers, end = EndOf(block, axis) + layers;
    box.first[axis] = periodic[axis] ? first : std::max(0, first);
    box.size[axis] = (periodic[axis] ? end : std::min(whole.size[axis], end)) - box.first[axis];
  }
  return box;
}

/// Intersections of a box with the grid and with the periodic images of the grid, beyond whose ends the box may reach.
std::vector<VoxelBox> PartsByPeriods(const VoxelBox& box, const Grid& whole)
{
  std::vector<VoxelBox> parts;
  const VoxelBox period = { {}, whole.size };
  // `back` moves the first voxel of `box` into the grid. The opposite shift moves the grid to the first periodic image
  // that the box overlaps.
  const std::array<int, 3> back = ShiftOf(box, whole.size);
  std::array<int, 3> by;
  for (by[2] = -back[2]; by[2] < EndOf(box, 2); by[2] += whole.size[2])
  {
    for (by[1] = -back[1]; by[1] < EndOf(box, 1); by[1] += whole.size[1])
    {
      for (by[0] = -back[0]; by[0] < EndOf(box, 0); by[0] += whole.size[0])
      {
        parts.push_back(Common(box, Moved(period, by)));
      }
    }
  }
  return parts;
}
}

GhostCells::GhostCells(Communicator& communicator, const std::vector<VoxelBox>& own,
  const std::vector<std::vector<VoxelBox>>& ghosts, const VoxelBox& held, const std::array<int, 3>& gridSize)
  : Comm(communicator)
{
  const int self = communicator.Rank();
  const auto shared = [&](int owner, int holder, bool ofHolder) {
    Shared cells = { ofHolder ? owner : holder, {} };
    for (const VoxelBox& box : ghosts[holder])
    {
      const std::array<int, 3> shift = ShiftOf(box, gridSize);
      if (owner != holder || shift != std::array<int, 3>{})
      {
        const VoxelBox common = Common(Moved(box, shift), own[owner]);
        AddPlaces(held, ofHolder ? Moved(common, shift, -1) : common, cells.places);
      }
    }
    return cells;
  };
  for (int rank = 0; rank < communicator.Ranks(); ++rank)
  {
    if (Shared owned = shared(self, rank, false); !owned.places.empty())
    {
      this->Owned.push_back(std::move(owned));
    }
    if (Shared copied = shared(rank, self, true); !copied.places.empty())
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
void GhostCells::Fill(Value* values, int arrays, std::size_t stride, std::size_t components) const
{
  std::vector<Value> owned;
  for (const Shared& cells : this->Owned)
  {
    for (int array = 0; array < arrays; ++array)
    {
      for (const std::size_t place : cells.places)
      {
        const Value* const from = values + array * stride + place * components;
        owned.insert(owned.end(), from, from + components);
      }
    }
  }
  const std::vector<Value> copied = this->Exchange(owned, arrays * static_cast<int>(components));
  auto next = copied.begin();
  for (const Shared& cells : this->Copied)
  {
    for (int array = 0; array < arrays; ++array)
    {
      for (const std::size_t place : cells.places)
      {
        std::copy_n(next, components, values + array * stride + place * components);
        next += static_cast<std::ptrdiff_t>(components);
      }
    }
  }
}

template void GhostCells::Fill(double*, int, std::size_t, std::size_t) const;
template void GhostCells::Fill(float*, int, std::size_t, std::size_t) const;

std::vector<std::size_t> GhostCells::PlacesOf(const std::vector<Shared>& shared)
{
  std::vector<std::size_t> places;
  for (const Shared& cells : shared)
  {
    places.insert(places.end(), cells.places.begin(), cells.places.end());
  }
  return places;
}

template <class Value>
void GhostCells::AddToOwners(std::vector<Value>& values) const
{
  for (const Shared& copied : this->Copied)
  {
    std::vector<Value> message(copied.places.size());
    std::transform(
      copied.places.begin(), copied.places.end(), message.begin(), [&](std::size_t place) { return values[place]; });
    this->Comm.Send(copied.rank, MessageTag::GhostCells, message);
  }
  for (const Shared& owned : this->Owned)
  {
    const std::vector<Value> message = this->Comm.Receive<Value>(owned.rank, MessageTag::GhostCells);
    for (std::size_t i = 0; i < message.size(); ++i)
    {
      values[owned.places[i]] += message[i];
    }
  }
}

template void GhostCells::AddToOwners(std::vector<double>&) const;
template void GhostCells::AddToOwners(std::vector<std::int64_t>&) const;

Halo::Halo(Communicator& communicator, const BlockPartition& partition, const std::array<bool, 3>& periodic, int layers)
  : All(partition.whole)
  , Around(periodic)
  , OwnBox(partition.blocks[communicator.Rank()])
  , Box(WithHalo(this->OwnBox, partition.whole, periodic, layers))
{
  std::vector<std::vector<VoxelBox>> ghosts;
  for (const VoxelBox& block : partition.blocks)
  {
    ghosts.push_back(PartsByPeriods(WithHalo(block, partition.whole, periodic, layers), partition.whole));
  }
  this->Ghosts.emplace(communicator, partition.blocks, ghosts, this->Box, partition.whole.size);
}

Grid Halo::KnownGrid() const
{
  return BlockPartition{ this->All, { this->Box } }.OwnGrid(0);
}

std::vector<float> Halo::Spread(const std::vector<float>& own, int components) const
{
  std::vector<float> values(this->Box.VoxelCount() * static_cast<std::size_t>(components));
  PutPart(own, values, this->Box, this->OwnBox, components);
  this->Ghosts->FillComponents(values, components);
  return values;
}

Field Halo::Spread(const Field& own, std::vector<float>& values) const
{
  if (!own.values)
  {
    return own;
  }
  const std::size_t count = this->OwnBox.VoxelCount() * static_cast<std::size_t>(own.components);
  values = this->Spread(std::vector<float>(own.values, own.values + count), own.components);
  Field known = own;
  known.values = values.data();
  return known;
}

std::vector<std::int64_t> Halo::Gather(std::vector<std::int64_t> known) const
{
  this->Ghosts->AddToOwners(known);
  return PartOf(known, this->Box, this->OwnBox);
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
