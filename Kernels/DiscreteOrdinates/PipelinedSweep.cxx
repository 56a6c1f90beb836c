#include "DiscreteOrdinates/PipelinedSweep.h"

#include "LightPropagation/Sweep/Pipelined/SweepInBlocks.h"
#include "Medium/BoxFaces.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
/// Bit mask of the faces -x, +x, ... +z of this rank's block that are interior to the grid (SweptFaces::inner).
int InnerFacesOf(const Domain& domain)
{
  const VoxelBox& block = domain.Own();
  int inner = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    inner |= block.first[axis] > 0 ? 1 << (2 * axis) : 0;
    inner |= EndOf(block, axis) < domain.Whole().size[axis] ? 1 << (2 * axis + 1) : 0;
  }
  return inner;
}

/// Axis along which light crosses between two blocks in contact, for rays that march along z.
int AxisOf(BlockContact::Kind kind)
{
  return kind == BlockContact::AsideU ? 0 : kind == BlockContact::AsideV ? 1 : 2;
}
}

CellsOfBlock::CellsOfBlock(Device& device, const Domain& domain, const Grid& own, const std::array<bool, 3>& periodic,
  const LightOfCells& ofWhole)
  : TheDevice(device)
  , TheDomain(domain)
  , OfWhole(ofWhole)
  , Out(device, BoxFaceCellCount(own), "the light that leaves by cells")
  , In(device, BoxFaceCellCount(own), "the light that faces give back")
  , OfBlock{ this->Out, this->In }
{
  const VoxelBox& block = domain.Own();
  const int inner = InnerFacesOf(domain);
  ForBoxFaceCells(own, [&](const BoxFaceCell& cell) {
    if (!(inner >> cell.face & 1) && !periodic[cell.face / 2])
    {
      const std::size_t there = LayoutOfFace(domain.Whole(), cell.face).CellAt(block.VoxelAt(cell.voxel));
      this->Places.push_back({ cell.number, ofWhole.first + there });
    }
  });
  this->Out.Fill(0.0f);
}

void CellsOfBlock::LetIn()
{
  const std::vector<float> ofWhole = this->OfWhole.in.Read();
  std::vector<float> in(this->In.Size(), 0.0f);
  for (const auto& [here, there] : this->Places)
  {
    in[here] = ofWhole[there];
  }
  this->In.Write(in.data());
}

void CellsOfBlock::LetOut(const std::function<void()>& leave)
{
  std::vector<double> left;
  this->TheDomain.Collective([&] {
    left.resize(this->OfWhole.out.Size(), 0.0);
    this->Out.Fill(0.0f);
    leave();
    const std::vector<float> out = this->Out.Read();
    for (const auto& [here, there] : this->Places)
    {
      left[there] = out[here];
    }
  });
  AddOverRanks(this->TheDevice, this->TheDomain.Comm(), left, this->OfWhole.out);
}

PipelinedSweep::PipelinedSweep(
  Device& device, const Domain& domain, const Grid& grid, const OrdinateGroups& groups, const SweptFaces& faces)
  : TheDevice(device)
  , TheDomain(domain)
  , TheGrid(grid)
  , Sweep(device, grid, groups, this->FacesOfBlock(faces))
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
  std::vector<ParallelBundles> ways;
  for (Octant& octant : this->Octants)
  {
    this->FindContacts(octant, faces);
    ways.push_back(octant.way);
  }
  SweepCosts costs;
  costs.ofTask = 1.0;
  this->Order = SweepSchedule(domain.Partition(), ways, costs).OrderOf(domain.Rank());
}

void PipelinedSweep::FindContacts(Octant& octant, const SweptFaces& faces) const
{
  const int self = this->TheDomain.Rank();
  const auto add = [&](int from, int to, std::vector<BlockContact>& straight, std::vector<BlockContact>& around) {
    for (const BlockContact& contact :
      ContactsBetween(this->TheDomain.Partition(), octant.way, from, to, faces.periodic))
    {
      if (!faces.unvarying[AxisOf(contact.kind)])
      {
        (contact.around ? around : straight).push_back(contact);
      }
    }
  };
  for (int rank = 0; rank < this->TheDomain.Comm().Ranks(); ++rank)
  {
    add(rank, self, octant.senders, octant.aroundFrom);
    add(self, rank, octant.receivers, octant.aroundTo);
  }
  octant.waiting.resize(octant.aroundFrom.size());
}

/// Boundary conditions of the block. If faces of the whole grid reflect, makes Cells, the outgoing and reflected light
/// by cell of the block's faces.
SweptFaces PipelinedSweep::FacesOfBlock(const SweptFaces& ofWhole)
{
  SweptFaces faces = ofWhole;
  faces.inner = InnerFacesOf(this->TheDomain);
  if (ofWhole.reflecting)
  {
    this->Cells.emplace(this->TheDevice, this->TheDomain, this->TheGrid, faces.periodic, *ofWhole.reflecting);
    faces.reflecting = &this->Cells->Seen();
  }
  return faces;
}

/// Calls visit(place) for each group of directions of an octant and each voxel face in the area of contact with another
/// block. `place` is the index of the face's radiance among the values of ReadFace() for the octant. The order is the
/// same on both ranks.
template <class Visit>
void PipelinedSweep::ForFace(
  const Octant& octant, const BlockContact& contact, const VoxelBox& cells, const Visit& visit) const
{
  // u: axis along the rows of voxels of the face; v: axis along which the rows follow each other
  const int axis = AxisOf(contact.kind), u = axis == 0 ? 1 : 0, v = axis == 2 ? 1 : 2;
  const VoxelBox& block = this->TheDomain.Own();
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

/// Copies received radiance of an octant to `faces`, the radiance through the faces of the block, which is read from
/// the device on first use.
void PipelinedSweep::Enter(
  const Octant& octant, const BlockContact& contact, const std::vector<float>& message, Faces& faces) const
{
  const int axis = AxisOf(contact.kind);
  std::vector<float>& face = faces[axis];
  face = face.empty() ? this->Sweep.ReadFace(axis, octant.first, octant.groups) : std::move(face);
  auto from = message.begin();
  this->ForFace(octant, contact, contact.cells, [&](std::size_t place) {
    std::copy_n(from, OrdinateLanes, face.begin() + static_cast<std::ptrdiff_t>(place));
    from += OrdinateLanes;
  });
}

void PipelinedSweep::TakeFrom(const Octant& octant, int number)
{
  Faces faces;
  for (const BlockContact& contact : octant.senders)
  {
    const std::vector<float> message = this->TheDomain.Comm().Receive<float>(contact.from, number);
    this->Failure.broken = this->Failure.broken || message.empty();
    this->Failure.Attempt([&] { this->Enter(octant, contact, message, faces); });
  }
  this->Failure.Attempt([&] {
    for (std::size_t i = 0; i < octant.aroundFrom.size(); ++i)
    {
      if (!octant.waiting[i].empty())
      {
        this->Enter(octant, octant.aroundFrom[i], octant.waiting[i], faces);
      }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      if (!faces[axis].empty())
      {
        this->Sweep.WriteFace(axis, octant.first, faces[axis]);
      }
    }
  });
}

/// Receives the radiance that wraps around periodic axes, after all octants have been swept, and stores it in `waiting`
/// for the next sweep.
void PipelinedSweep::TakeFromAround()
{
  for (const int number : this->Order)
  {
    Octant& octant = this->Octants[number];
    for (std::size_t i = 0; i < octant.aroundFrom.size(); ++i)
    {
      octant.waiting[i] = this->TheDomain.Comm().Receive<float>(octant.aroundFrom[i].from, number);
      this->Failure.broken = this->Failure.broken || octant.waiting[i].empty();
    }
  }
}

void PipelinedSweep::GiveTo(const Octant& octant, int number)
{
  Faces faces;
  const auto give = [&](const BlockContact& contact) {
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
    this->TheDomain.Comm().Send(contact.to, number, this->Failure.broken ? std::vector<float>() : message);
  };
  std::for_each(octant.receivers.begin(), octant.receivers.end(), give);
  std::for_each(octant.aroundTo.begin(), octant.aroundTo.end(), give);
}

void PipelinedSweep::Forget()
{
  for (Octant& octant : this->Octants)
  {
    octant.waiting.assign(octant.aroundFrom.size(), {});
  }
  this->Sweep.Forget();
}

FacePowers PipelinedSweep::Apply(
  const OrdinateArrays& arrays, const IncomingRadiance& incoming, bool, const Monitor& monitor)
{
  this->Failure = {};
  FacePowers powers;
  this->Failure.Attempt([&] {
    if (this->Cells)
    {
      this->Cells->LetIn();
    }
  });
  this->Failure.Attempt([&] { this->Sweep.LetIn(incoming, powers, arrays.onlyWraps); });
  for (std::size_t i = 0; i < this->Order.size(); ++i)
  {
    const Octant& octant = this->Octants[this->Order[i]];
    const double all = static_cast<double>(this->Order.size());
    this->TakeFrom(octant, this->Order[i]);
    this->Failure.Attempt(
      [&] { this->Sweep.SweepGroups(octant.first, octant.groups, arrays, OfPart(monitor, i / all, (i + 1) / all)); });
    this->GiveTo(octant, this->Order[i]);
  }
  this->TakeFromAround();
  this->TheDomain.Collective([&] {
    this->Failure.Throw();
    if (!this->Failure.broken)
    {
      this->Sweep.Count(powers);
    }
  });
  std::vector<double> sums(powers.in.begin(), powers.in.end());
  sums.insert(sums.end(), powers.out.begin(), powers.out.end());
  sums.push_back(powers.onTheWay);
  sums = this->TheDomain.Sum(sums);
  std::copy_n(sums.begin(), 6, powers.in.begin());
  std::copy_n(sums.begin() + 6, 6, powers.out.begin());
  powers.onTheWay = sums.back();
  if (this->Cells)
  {
    this->Cells->LetOut([&] { this->Sweep.LeaveByCells(); });
  }
  return powers;
}
}
