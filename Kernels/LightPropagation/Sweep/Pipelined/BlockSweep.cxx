#include "LightPropagation/Sweep/Pipelined/BlockSweep.h"

#include "LightPropagation/Sweep/SweepBorder.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Plan of the sweep of a block: rays make the same sideways moves as in a sweep of the whole domain, and the arrays
/// are those of the block.
SweepPlan PlanOf(
  Device& device, const BlockPartition& partition, int rank, const ParallelBundles& rays, const SweepVolume& volume)
{
  SweepDescription sweep = Describe(volume, {});
  sweep.grid = partition.whole;
  sweep.box = partition.blocks[rank];
  // The plan must provide arrays for rays that enter through the sides, as if incident light were given per cell of the
  // faces
  sweep.faceIn = true;
  SweepPlan plan(device, sweep, { rays.axis, rays.bundles });
  const std::array<int, 3>& n = partition.blocks[rank].size;
  const std::array<int, 3> step = { 1, n[0], n[0] * n[1] };
  PlaneInfo& plane = plan.plane;
  plane.firstU = plane.firstV = plane.firstP = 0;
  plane.stepU = step[plan.axes.u];
  plane.stepV = step[plan.axes.v];
  plane.stepP = step[plan.axes.axis];
  return plan;
}
}

BlockSweep::BlockSweep(Device& device, const BlockPartition& partition, int rank, const ParallelBundles& rays,
  const std::array<bool, 3>& periodic, const SweepVolume& volume, BlockWorkspace& workspace)
  : Bundles(rays)
  , Periodic(periodic)
  , Whole(partition.whole)
  , Block(partition.blocks[rank])
  , Plan(PlanOf(device, partition, rank, rays, volume))
  , Rays{ this->Plan, rays.way, periodic[rays.axis] }
  , SideFloats(this->Rays.SideFloats())
  , RayCount(this->Plan.eachWay.radiance)
{
  if (this->Rays.around)
  {
    this->Plan.LetRaysGoOn();
  }
  ReserveOnDevice(device, workspace.sidesIn, this->Rays.Sides(), "the rays that come in from other blocks");
  ReserveOnDevice(device, workspace.sidesOut, this->Rays.Sides(), "the rays that go out to other blocks");
  this->Carrier = device.IsCpu() ? MakeBlockCrossingOnCpu(device, this->Rays, workspace)
                                 : MakeBlockCrossingOnGpu(device, this->Rays, workspace);
  this->LayPattern();
}

void BlockSweep::BeginLap(int planes)
{
  if (planes != this->LapPlanes)
  {
    this->LapPlanes = planes;
    this->LayPattern();
  }
}

/// Computes the moves and segments of rays in the block's planes for the current lap around a periodic axis.
void BlockSweep::LayPattern()
{
  const SweepPlan& plan = this->Plan;
  this->Crossings = plan.Crossings(this->LapPlanes + plan.PlanesBefore(this->Bundles.way), plan.Planes());
  this->Moves.clear();
  for (const Bundle& bundle : plan.bundles)
  {
    this->Moves.push_back(SidewaysMoves(bundle, this->LapPlanes, this->Whole.size[plan.axes.axis]));
  }
  this->Carrier->LayPattern(this->LapPlanes);
}

int BlockSweep::DirectionOf(const Member& member) const
{
  return this->Bundles.way == 0 ? member.direction : member.opposite;
}

bool BlockSweep::IsAtEnd(int axis, bool entry) const
{
  const bool low = (this->Bundles.signs[axis] > 0) == entry;
  return low ? this->Block.first[axis] == 0 : EndOf(this->Block, axis) == this->Whole.size[axis];
}

BlockSweep::Light BlockSweep::LightOf(const SweepBoundary& boundary, std::size_t b, const Member& member) const
{
  const PlaneAxes& axes = this->Plan.axes;
  const float power = static_cast<float>(this->Plan.bundles[b].power);
  const auto through = [&](int axis) {
    Rgb light = boundary && !this->Periodic[axis]
      ? boundary(this->DirectionOf(member), EntryFace(axis, this->Bundles.signs[axis] > 0))
      : Rgb{};
    for (double& value : light)
    {
      value = static_cast<float>(value * power);
    }
    return light;
  };
  return { through(axes.u), through(axes.v), through(axes.axis) };
}

/// Calls act(incident power, bundle, index [member][channel] within the bundle, channel) for each direction (member) of
/// each bundle and each channel. Does nothing if no light is incident.
template <class Act>
void BlockSweep::ForRaysFrom(const SweepBoundary& boundary, const Act& act) const
{
  const SweepPlan& plan = this->Plan;
  for (std::size_t b = 0; boundary && b < plan.bundles.size(); ++b)
  {
    const BundleInfo& bundle = plan.bundleRows[b];
    for (int m = 0; m < bundle.members; ++m)
    {
      const Light light = this->LightOf(boundary, b, plan.bundles[b].members[m]);
      for (int c = 0; c < plan.channels; ++c)
      {
        act(light, bundle, static_cast<std::size_t>(m) * plan.channels + c, c);
      }
    }
  }
}

RaysAtFaces BlockSweep::FromOutside(const SweepBoundary& boundary, const LightByCells& cells) const
{
  const SweepPlan& plan = this->Plan;
  RaysAtFaces rays;
  rays.maps.assign(this->Carrier->MapFloats(), 0.0f);
  rays.sides.assign(this->Rays.Sides(), 0.0f);
  const bool beginHere = this->IsOuter(plan.axes.axis, true);
  this->ForRaysFrom(boundary, [&](const Light& light, const BundleInfo& bundle, std::size_t slot, int c) {
    this->FillSides(light, bundle.border + slot, c, rays);
    for (int v = 0; beginHere && v < plan.plane.sizeV; ++v)
    {
      float* row = rays.maps.data() + this->Carrier->RowOfMap(bundle, slot, v);
      std::fill(row, row + plan.plane.sizeU, static_cast<float>(light.along[c]));
    }
  });
  if (cells.in)
  {
    ByCells(*this, cells).Enter(rays);
  }
  return rays;
}

/// Writes the power of rays incident from outside the domain to the block's sides. At an edge of the domain, half of
/// the power of a ray that moves along u and v at once enters through each of the two faces.
void BlockSweep::FillSides(const Light& light, std::size_t ray, int c, RaysAtFaces& rays) const
{
  const bool outerU = this->IsOuter(this->Plan.axes.u, true), outerV = this->IsOuter(this->Plan.axes.v, true);
  const float u = outerU ? static_cast<float>(light.u[c]) : 0.0f, v = outerV ? static_cast<float>(light.v[c]) : 0.0f;
  for (int k = 0; k < this->Plan.Planes(); ++k)
  {
    float* side = rays.sides.data() + (k * this->RayCount + ray) * this->SideFloats;
    float* acrossU = side + this->Plan.plane.sizeU;
    float* edge = acrossU + this->Plan.plane.sizeV;
    std::fill(side, acrossU, v);
    std::fill(acrossU, edge, u);
    *edge = outerU && outerV ? 0.5f * (u + v) : u + v;
  }
}

std::array<Rgb, 6> BlockSweep::PowerIn(const SweepBoundary& boundary) const
{
  std::array<Rgb, 6> power = {};
  const PlaneAxes& axes = this->Plan.axes;
  const auto face = [this](int axis) { return EntryFace(axis, this->Bundles.signs[axis] > 0); };
  const double sizeU = this->Whole.size[axes.u], sizeV = this->Whole.size[axes.v];
  for (std::size_t b = 0; boundary && b < this->Plan.bundles.size(); ++b)
  {
    for (const Member& member : this->Plan.bundles[b].members)
    {
      const Light light = this->LightOf(boundary, b, member);
      const bool swapped = member.uFromU == 0;
      for (int c = 0; c < this->Plan.channels; ++c)
      {
        power[face(axes.axis)][c] += light.along[c] * sizeU * sizeV;
        power[face(axes.u)][c] += light.u[c] * this->Moves[b][swapped ? 1 : 0] * sizeV;
        power[face(axes.v)][c] += light.v[c] * this->Moves[b][swapped ? 0 : 1] * sizeU;
      }
    }
  }
  return power;
}

RaysAtFaces BlockSweep::Cross(const SweepVolume& volume, RaysAtFaces in, const SweepBoundary& boundary,
  const LightByCells& cells, SweepTally& tally, const Monitor& monitor)
{
  const std::vector<float> aside =
    this->Carrier->Cross(volume, this->LightBeyond(boundary), this->OuterSides(), in, monitor);
  this->CountLeft(aside, in, tally);
  if (cells.in || cells.left)
  {
    ByCells(*this, cells).Leave(in, boundary, tally);
  }
  return in;
}

std::vector<cl_float4> BlockSweep::LightBeyond(const SweepBoundary& boundary) const
{
  std::vector<cl_float4> beyond(this->RayCount, cl_float4{});
  this->ForRaysFrom(boundary, [&](const Light& light, const BundleInfo& bundle, std::size_t slot, int c) {
    cl_float4& ofRay = beyond[bundle.border + slot];
    ofRay.s[0] = static_cast<float>(light.u[c]);
    ofRay.s[1] = static_cast<float>(light.v[c]);
  });
  return beyond;
}

/// Bit mask of the block's sides -u, +u, -v, +v (bits 0 to 3) through which rays leave the domain.
int BlockSweep::OuterSides() const
{
  int outer = 0;
  for (int side = 0; side < 4; ++side)
  {
    const int axis = side < 2 ? this->Plan.axes.u : this->Plan.axes.v;
    const bool exit = (side % 2 == 1) == (this->Bundles.signs[axis] > 0);
    outer |= exit && this->IsOuter(axis, false) ? 1 << side : 0;
  }
  return outer;
}

/// Adds the power that leaves the domain from this block to the tally.
/// @param aside  power that left the domain sideways, W, consecutive arrays [-u, +u, -v, +v][channel]
void BlockSweep::CountLeft(const std::vector<float>& aside, const RaysAtFaces& out, SweepTally& tally) const
{
  const SweepPlan& plan = this->Plan;
  const PlaneAxes& axes = plan.axes;
  CountSideways(plan, aside, tally);
  if (!this->IsAtEnd(axes.axis, false))
  {
    return;
  }
  Rgb& ahead = this->Periodic[axes.axis] ? tally.onTheWay : tally.out[2 * axes.axis + 1 - this->Bundles.way];
  for (const BundleInfo& bundle : plan.bundleRows)
  {
    const int slots = bundle.members * plan.channels;
    for (int row = 0; row < plan.plane.sizeV * slots; ++row)
    {
      const float* rays = out.maps.data() + this->Carrier->RowOfMap(bundle, row % slots, row / slots);
      double& sum = ahead[row % plan.channels];
      for (int u = 0; u < plan.plane.sizeU; ++u)
      {
        sum += rays[u];
      }
    }
  }
}

/// Calls visit(inSides, place) for each ray that crosses a contact (the voxel faces shared by two blocks). `place` is
/// an index into RaysAtFaces::sides if inSides, else into RaysAtFaces::maps. Sender and receiver use the same order,
/// that of the cells in the whole domain.
/// @param out  true: indices of outgoing rays; false: of incoming rays
template <class Visit>
void BlockSweep::ForEachPlace(const BlockContact& contact, bool out, const Visit& visit) const
{
  if (contact.kind == BlockContact::Along)
  {
    this->ForEachPlaceAlong(contact, visit);
    return;
  }
  const SweepPlan& plan = this->Plan;
  const PlaneAxes& axes = plan.axes;
  const VoxelBox& cells = contact.cells;
  const int firstU = cells.first[axes.u] - this->Block.first[axes.u], endU = firstU + cells.size[axes.u];
  const int firstV = cells.first[axes.v] - this->Block.first[axes.v], endV = firstV + cells.size[axes.v];
  // Column of the block from which rays leave through the face normal to u
  const int edgeU = this->Bundles.signs[axes.u] > 0 ? plan.plane.sizeU - 1 : 0;
  for (int plane = 0; plane < cells.size[axes.axis]; ++plane)
  {
    const int inBlock = cells.first[axes.axis] - this->Block.first[axes.axis] + plane;
    const int k = this->Bundles.way == 0 ? inBlock : plan.Planes() - 1 - inBlock;
    this->ForRaysThatMove(k, contact.kind, [&](std::size_t ray) {
      const std::size_t acrossV = (k * this->RayCount + ray) * this->SideFloats;
      const std::size_t acrossU = acrossV + plan.plane.sizeU;
      for (int v = firstV; contact.kind == BlockContact::AsideU && v < endV; ++v)
      {
        visit(true, acrossU + v);
      }
      for (int u = firstU; contact.kind == BlockContact::AsideV && u < endU; ++u)
      {
        visit(true, acrossV + u);
      }
      if (contact.kind == BlockContact::Edge)
      {
        visit(true, !out ? acrossU + plan.plane.sizeV : firstU == edgeU ? acrossU + firstV : acrossV + firstU);
      }
    });
  }
}

/// Calls visit(false, place) for each ray that crosses a contact of the kind Along, i.e. the voxel faces behind the
/// last plane of a block. `place` is an index into RaysAtFaces::maps, the powers of the rays.
template <class Visit>
void BlockSweep::ForEachPlaceAlong(const BlockContact& contact, const Visit& visit) const
{
  const PlaneAxes& axes = this->Plan.axes;
  const VoxelBox& cells = contact.cells;
  const int firstU = cells.first[axes.u] - this->Block.first[axes.u], endU = firstU + cells.size[axes.u];
  const int firstV = cells.first[axes.v] - this->Block.first[axes.v], endV = firstV + cells.size[axes.v];
  for (const BundleInfo& bundle : this->Plan.bundleRows)
  {
    const int slots = bundle.members * this->Plan.channels;
    for (int v = firstV; v < endV; ++v)
    {
      for (int slot = 0; slot < slots; ++slot)
      {
        const std::size_t row = this->Carrier->RowOfMap(bundle, slot, v);
        for (int u = firstU; u < endU; ++u)
        {
          visit(false, row + u);
        }
      }
    }
  }
}

/// Calls act(ray) for the rays of all bundles and channels that move sideways in plane k of the block: along u if
/// `kind` is AsideU, along v if AsideV, along both at once if Edge.
template <class Act>
void BlockSweep::ForRaysThatMove(int k, BlockContact::Kind kind, const Act& act) const
{
  const SweepPlan& plan = this->Plan;
  const auto isOfKind = [kind](const std::array<int, 2>& move) {
    return (kind == BlockContact::AsideV || move[0] != 0) && (kind == BlockContact::AsideU || move[1] != 0);
  };
  for (std::size_t b = 0; b < plan.bundles.size(); ++b)
  {
    const BundleInfo& bundle = plan.bundleRows[b];
    const CrossingInfo& crossing = this->Crossings[k * plan.bundles.size() + b];
    for (int slot = 0; slot < bundle.members * plan.channels; ++slot)
    {
      bool moves = false;
      for (int s = 1; s < crossing.stages; ++s)
      {
        moves = moves || isOfKind(MoveOf(bundle, slot / plan.channels, crossing, s));
      }
      if (moves)
      {
        act(bundle.border + slot);
      }
    }
  }
}

void BlockSweep::Pack(const BlockContact& contact, const RaysAtFaces& out, std::vector<float>& message) const
{
  this->ForEachPlace(
    contact, true, [&](bool aside, std::size_t place) { message.push_back((aside ? out.sides : out.maps)[place]); });
}

void BlockSweep::Unpack(
  const BlockContact& contact, const std::vector<float>& message, std::size_t& at, RaysAtFaces& in) const
{
  this->ForEachPlace(
    contact, false, [&](bool aside, std::size_t place) { (aside ? in.sides : in.maps)[place] = message.at(at++); });
}

std::size_t BlockSweep::Values(const std::vector<BlockContact>& contacts) const
{
  std::size_t values = 0;
  for (const BlockContact& contact : contacts)
  {
    this->ForEachPlace(contact, false, [&](bool, std::size_t) { ++values; });
  }
  return values;
}
}
