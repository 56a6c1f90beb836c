#include "DiscreteOrdinates/Distributed/UpwindSweepInBlocks.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int Everywhere = 0x3f; ///< all six faces

/// Faces of a rank's block that are no faces of the grid.
int InnerFacesOf(const OrdinatesRanks& ranks)
{
  const VoxelBox& block = ranks.partition.blocks[ranks.others.Rank()];
  int inner = ranks.Has() ? 0 : Everywhere;
  for (int axis = 0; axis < 3; ++axis)
  {
    inner |= block.first[axis] > 0 ? 1 << (2 * axis) : 0;
    inner |= EndOf(block, axis) < ranks.partition.whole.size[axis] ? 1 << (2 * axis + 1) : 0;
  }
  return inner;
}

/// Axis across which light goes from one block to another. Rays march along z.
int AxisOf(BlockContact::Kind kind)
{
  return kind == BlockContact::AsideU ? 0 : kind == BlockContact::AsideV ? 1 : 2;
}
}

UpwindSweepInBlocks::UpwindSweepInBlocks(
  Device& device, const OrdinatesRanks& ranks, const Grid& grid, const OrdinateGroups& groups)
  : Ranks(ranks)
  , TheGrid(grid)
  , Sweep(device, grid, groups, {}, nullptr, InnerFacesOf(ranks))
{
  for (int g = 0; g < groups.Count(); ++g)
  {
    const std::array<bool, 3>& up = groups.All()[g].up;
    if (g == 0 || up != groups.All()[g - 1].up)
    {
      Octant octant;
      octant.way = { 2, up[2] ? 0 : 1, { up[0] ? 1 : -1, up[1] ? 1 : -1, up[2] ? 1 : -1 }, {}, false };
      octant.first = g;
      this->Octants.push_back(std::move(octant));
    }
    ++this->Octants.back().groups;
  }
  const int self = ranks.others.Rank();
  std::vector<ParallelBundles> ways;
  for (Octant& octant : this->Octants)
  {
    for (int rank = 0; rank < ranks.others.Ranks(); ++rank)
    {
      const std::vector<BlockContact> from = ContactsBetween(ranks.partition, octant.way, rank, self);
      const std::vector<BlockContact> to = ContactsBetween(ranks.partition, octant.way, self, rank);
      octant.senders.insert(octant.senders.end(), from.begin(), from.end());
      octant.receivers.insert(octant.receivers.end(), to.begin(), to.end());
    }
    ways.push_back(octant.way);
  }
  SweepCosts costs;
  costs.ofTask = 1.0;
  this->Order = SweepSchedule(ranks.partition, ways, costs).OrderOf(self);
}

/// visit(place in the octant's values of the face) for each group and cell of a contact, in an order that both ranks
/// know.
/// @param cells  of this block's layer at the face
template <class Visit>
void UpwindSweepInBlocks::ForFace(
  const Octant& octant, const BlockContact& contact, const VoxelBox& cells, const Visit& visit) const
{
  const int axis = AxisOf(contact.kind), u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2; // u along rows
  const VoxelBox& block = this->Ranks.partition.blocks[this->Ranks.others.Rank()];
  const std::size_t rows = block.size[v], row = block.size[u];
  for (std::size_t g = 0; g < static_cast<std::size_t>(octant.groups); ++g)
  {
    for (int j = 0; j < cells.size[v]; ++j)
    {
      const std::size_t first =
        (g * rows + cells.first[v] - block.first[v] + j) * row + cells.first[u] - block.first[u];
      for (int i = 0; i < cells.size[u]; ++i)
      {
        visit((first + i) * OrdinateLanes);
      }
    }
  }
}

void UpwindSweepInBlocks::TakeFrom(const Octant& octant, int number)
{
  std::array<std::vector<float>, 3> faces;
  for (const BlockContact& contact : octant.senders)
  {
    const std::vector<float> message = this->Ranks.others.Receive<float>(contact.from, number);
    this->Failure.broken = this->Failure.broken || message.empty();
    this->Failure.Attempt([&] {
      const int axis = AxisOf(contact.kind);
      std::vector<float>& face = faces[axis];
      face = face.empty() ? this->Sweep.ReadFace(axis, octant.first, octant.groups) : std::move(face);
      auto from = message.begin();
      this->ForFace(octant, contact, contact.cells, [&](std::size_t place) {
        std::copy_n(from, OrdinateLanes, face.begin() + static_cast<std::ptrdiff_t>(place));
        from += OrdinateLanes;
      });
    });
  }
  this->Failure.Attempt([&] {
    for (int axis = 0; axis < 3; ++axis)
    {
      if (!faces[axis].empty())
      {
        this->Sweep.WriteFace(axis, octant.first, faces[axis]);
      }
    }
  });
}

void UpwindSweepInBlocks::GiveTo(const Octant& octant, int number)
{
  std::array<std::vector<float>, 3> faces;
  for (const BlockContact& contact : octant.receivers)
  {
    std::vector<float> message;
    this->Failure.Attempt([&] {
      const int axis = AxisOf(contact.kind);
      std::vector<float>& face = faces[axis];
      face = face.empty() ? this->Sweep.ReadFace(axis, octant.first, octant.groups) : std::move(face);
      this->ForFace(octant, contact, contact.cells, [&](std::size_t place) {
        const auto from = face.begin() + static_cast<std::ptrdiff_t>(place);
        message.insert(message.end(), from, from + OrdinateLanes);
      });
    });
    this->Ranks.others.Send(contact.to, number, this->Failure.broken ? std::vector<float>() : message);
  }
}

FacePowers UpwindSweepInBlocks::Apply(const Buffer<float>& radiance, const Buffer<float>& sigma_t,
  const Buffer<float>& scale, const IncomingRadiance& incoming, const Monitor& monitor)
{
  this->Failure = {};
  FacePowers powers;
  this->Failure.Attempt([&] { this->Sweep.LetIn(incoming, powers); });
  for (std::size_t i = 0; i < this->Order.size(); ++i)
  {
    const Octant& octant = this->Octants[this->Order[i]];
    const double all = static_cast<double>(this->Order.size());
    this->TakeFrom(octant, this->Order[i]);
    this->Failure.Attempt([&] {
      this->Sweep.SweepGroups(
        octant.first, octant.groups, radiance, sigma_t, scale, OfPart(monitor, i / all, (i + 1) / all));
    });
    this->GiveTo(octant, this->Order[i]);
  }
  this->Ranks.others.Together([&] {
    if (this->Failure.error)
    {
      std::rethrow_exception(this->Failure.error);
    }
    if (this->Ranks.Has() && !this->Failure.broken)
    {
      this->Sweep.Count(powers);
    }
  });
  std::vector<double> sums(powers.in.begin(), powers.in.end());
  sums.insert(sums.end(), powers.out.begin(), powers.out.end());
  sums = this->Ranks.others.Sum(sums);
  std::copy_n(sums.begin(), 6, powers.in.begin());
  std::copy_n(sums.begin() + 6, 6, powers.out.begin());
  return powers;
}
}
