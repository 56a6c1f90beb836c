#include "LightPropagation/Sweep/Pipelined/BlockSweep.h"

namespace tyndall
{
std::array<int, 2> MoveOf(const BundleInfo& bundle, int member, const CrossingInfo& crossing, int stage)
{
  const cl_int* move = bundle.move[member];
  return { move[0] * crossing.moveU[stage] + move[1] * crossing.moveV[stage],
    move[2] * crossing.moveU[stage] + move[3] * crossing.moveV[stage] };
}

BlockSweep::ByCells::ByCells(const BlockSweep& sweep, const LightByCells& cells)
  : Sweep(sweep)
  , Cells(cells)
  , CellCount(BoxFaceCellCount(sweep.Whole))
{
  for (int face = 0; face < 6; ++face)
  {
    this->Faces[face] = LayoutOfFace(sweep.Whole, face);
  }
}

/// Calls act(Aside) for each sideways move of rays in the block's planes, for each direction of each bundle and each
/// channel; does nothing if no face of the block parallel to the marching axis is a face of the domain.
template <class Act>
void BlockSweep::ByCells::ForAside(const Act& act) const
{
  const SweepPlan& plan = this->Sweep.Plan;
  const auto touches = [this](int axis) { return this->Sweep.IsOuter(axis, true) || this->Sweep.IsOuter(axis, false); };
  const int planes = touches(plan.axes.u) || touches(plan.axes.v) ? plan.Planes() : 0;
  for (int k = 0; k < planes; ++k)
  {
    for (std::size_t b = 0; b < plan.bundles.size(); ++b)
    {
      const BundleInfo& bundle = plan.bundleRows[b];
      const CrossingInfo& crossing = this->Sweep.Crossings[k * plan.bundles.size() + b];
      for (int slot = 0; slot < bundle.members * plan.channels; ++slot)
      {
        for (int s = 1; s < crossing.stages; ++s)
        {
          const int member = slot / plan.channels;
          const auto [du, dv] = MoveOf(bundle, member, crossing, s);
          act(Aside{ b, member, slot % plan.channels, k, du, dv, crossing.part[s],
            k * this->Sweep.RayCount + bundle.border + slot });
        }
      }
    }
  }
}

/// Calls act(bundle, channel, index in RaysAtFaces::maps, u, v) for every ray at an end of the marching axis.
template <class Act>
void BlockSweep::ByCells::ForEnds(const Act& act) const
{
  const SweepPlan& plan = this->Sweep.Plan;
  for (const BundleInfo& bundle : plan.bundleRows)
  {
    const int slots = bundle.members * plan.channels;
    for (int v = 0; v < plan.plane.sizeV; ++v)
    {
      for (int slot = 0; slot < slots; ++slot)
      {
        const std::size_t row = this->Sweep.Carrier->RowOfMap(bundle, slot, v);
        for (int u = 0; u < plan.plane.sizeU; ++u)
        {
          act(bundle, slot % plan.channels, row + u, u, v);
        }
      }
    }
  }
}

/// Voxel (u, v) of the plane in which the ray moves, indexed in the whole domain.
BlockSweep::ByCells::Voxel BlockSweep::ByCells::VoxelAt(const Aside& ray, int u, int v) const
{
  const SweepPlan& plan = this->Sweep.Plan;
  Voxel voxel = this->Sweep.Block.first;
  voxel[plan.axes.u] += u;
  voxel[plan.axes.v] += v;
  voxel[plan.axes.axis] += this->Sweep.Bundles.way == 0 ? ray.plane : plan.Planes() - 1 - ray.plane;
  return voxel;
}

/// Index of the block's first or last voxel along an axis: where rays enter (`entry`) or leave.
int BlockSweep::ByCells::Edge(int axis, bool entry) const
{
  return (this->Sweep.Bundles.signs[axis] > 0) == entry ? 0 : this->Sweep.Block.size[axis] - 1;
}

int BlockSweep::ByCells::EntryFaceOf(int axis) const
{
  return EntryFace(axis, this->Sweep.Bundles.signs[axis] > 0);
}

std::size_t BlockSweep::ByCells::CellOf(int face, const Voxel& voxel, int channel) const
{
  return channel * this->CellCount + this->Faces[face].CellAt(voxel);
}

double BlockSweep::ByCells::LightOf(int face, const Voxel& voxel, int channel) const
{
  return this->Cells.in ? this->Cells.in[this->CellOf(face, voxel, channel)] : 0.0;
}

/// Mean incident radiance of two cells of a face: the cell at `voxel`, and the cell one move of the ray further. If the
/// second cell is not on the face, the radiance of the first cell.
double BlockSweep::ByCells::MeanLight(int face, const Voxel& voxel, int aside, int move, int channel) const
{
  const int size = this->Sweep.Whole.size[aside];
  const bool wraps = this->Sweep.Periodic[aside];
  const auto place = [&](int at) { return wraps ? (at + size) % size : at; };
  Voxel there = voxel, beside = voxel;
  there[aside] = place(voxel[aside]);
  beside[aside] = place(voxel[aside] + move);
  const double here = this->LightOf(face, there, channel);
  return move == 0 || beside[aside] < 0 || beside[aside] >= size ? here
                                                                 : 0.5 * (here + this->LightOf(face, beside, channel));
}

void BlockSweep::ByCells::Enter(RaysAtFaces& in) const
{
  const PlaneAxes& axes = this->Sweep.Plan.axes;
  if (this->Sweep.IsOuter(axes.axis, true))
  {
    const int face = this->EntryFaceOf(axes.axis);
    this->ForEnds([&](const BundleInfo& bundle, int channel, std::size_t place, int u, int v) {
      in.maps[place] += static_cast<float>(bundle.power * this->LightOf(face, this->VoxelAt(Aside{}, u, v), channel));
    });
  }
  this->ForAside([&](const Aside& ray) { this->EnterAside(ray, in); });
}

void BlockSweep::ByCells::EnterAside(const Aside& ray, RaysAtFaces& in) const
{
  const SweepPlan& plan = this->Sweep.Plan;
  const PlaneAxes& axes = plan.axes;
  const double power = plan.bundleRows[ray.bundle].power;
  const int c = ray.channel;
  const bool outerU = ray.du != 0 && this->Sweep.IsOuter(axes.u, true);
  const bool outerV = ray.dv != 0 && this->Sweep.IsOuter(axes.v, true);
  const int faceU = this->EntryFaceOf(axes.u), faceV = this->EntryFaceOf(axes.v);
  const int u0 = this->Edge(axes.u, true), v0 = this->Edge(axes.v, true);
  float* const acrossV = in.sides.data() + ray.ray * this->Sweep.SideFloats;
  float* const acrossU = acrossV + plan.plane.sizeU;
  for (int x = 0; outerV && x < plan.plane.sizeU; ++x)
  {
    acrossV[x] += static_cast<float>(power * this->MeanLight(faceV, this->VoxelAt(ray, x, v0), axes.u, ray.du, c));
  }
  for (int y = 0; outerU && y < plan.plane.sizeV; ++y)
  {
    acrossU[y] += static_cast<float>(power * this->MeanLight(faceU, this->VoxelAt(ray, u0, y), axes.v, ray.dv, c));
  }
  if (ray.du == 0 || ray.dv == 0 || (!outerU && !outerV))
  {
    return;
  }
  // Incident radiance per cell for a ray that moves diagonally, along both transverse axes u and v, in one step.
  // Through an edge of the domain, half of its power enters through the face normal to u and half through the face
  // normal to v. If only one of these two faces of the block is a face of the domain, all of the power enters through
  // that one.
  const double beyond = outerU && outerV
    ? 0.5 * (this->LightOf(faceV, this->VoxelAt(ray, u0, v0), c) + this->LightOf(faceU, this->VoxelAt(ray, u0, v0), c))
    : outerV ? this->MeanLight(faceV, this->VoxelAt(ray, u0 - ray.du, v0), axes.u, ray.du, c)
             : this->MeanLight(faceU, this->VoxelAt(ray, u0, v0 - ray.dv), axes.v, ray.dv, c);
  acrossU[plan.plane.sizeV] += static_cast<float>(power * beyond);
}

void BlockSweep::ByCells::Leave(const RaysAtFaces& out, const SweepBoundary& boundary, SweepTally& tally) const
{
  const PlaneAxes& axes = this->Sweep.Plan.axes;
  if (this->Cells.left && this->Sweep.IsOuter(axes.axis, false))
  {
    const int face = this->EntryFaceOf(axes.axis) ^ 1;
    Aside last;
    last.plane = this->Sweep.Plan.Planes() - 1;
    this->ForEnds([&](const BundleInfo&, int channel, std::size_t place, int u, int v) {
      this->Cells.left[this->CellOf(face, this->VoxelAt(last, u, v), channel)] += out.maps[place];
    });
  }
  this->ForAside([&](const Aside& ray) {
    if (this->Cells.left)
    {
      this->LeaveAside(ray, out);
    }
    this->PassEdges(ray, boundary, tally);
  });
}

/// Sums the power that leaves through the faces parallel to the marching axis, per cell. If a ray leaves diagonally
/// through an edge of the domain, along both transverse axes u and v, half of its power is counted at each of the two
/// faces.
void BlockSweep::ByCells::LeaveAside(const Aside& ray, const RaysAtFaces& out) const
{
  const SweepPlan& plan = this->Sweep.Plan;
  const PlaneAxes& axes = plan.axes;
  const bool outerU = ray.du != 0 && this->Sweep.IsOuter(axes.u, false);
  const bool outerV = ray.dv != 0 && this->Sweep.IsOuter(axes.v, false);
  const int u1 = this->Edge(axes.u, false), v1 = this->Edge(axes.v, false);
  const float* const acrossV = out.sides.data() + ray.ray * this->Sweep.SideFloats;
  const float* const acrossU = acrossV + plan.plane.sizeU;
  for (int x = 0; outerV && x < plan.plane.sizeU; ++x)
  {
    const double half = outerU && x == u1 ? 0.5 : 1.0;
    this->LeaveThrough(ray, axes.v, this->VoxelAt(ray, x, v1), half * ray.part * acrossV[x]);
  }
  for (int y = 0; outerU && y < plan.plane.sizeV; ++y)
  {
    const double half = outerV && y == v1 ? 0.5 : 1.0;
    this->LeaveThrough(ray, axes.u, this->VoxelAt(ray, u1, y), half * ray.part * acrossU[y]);
  }
}

/// Sums the power of diagonally moving rays that enter the domain through one face at an edge, and leave at once
/// through the other face at this edge, without crossing a voxel.
void BlockSweep::ByCells::PassEdges(const Aside& ray, const SweepBoundary& boundary, SweepTally& tally) const
{
  if (ray.du == 0 || ray.dv == 0)
  {
    return;
  }
  const PlaneAxes& axes = this->Sweep.Plan.axes;
  const bool outU = this->Sweep.IsOuter(axes.u, false), inV = this->Sweep.IsOuter(axes.v, true);
  const bool outV = this->Sweep.IsOuter(axes.v, false), inU = this->Sweep.IsOuter(axes.u, true);
  if ((outU && inV) || (outV && inU))
  {
    const Light light =
      this->Sweep.LightOf(boundary, ray.bundle, this->Sweep.Plan.bundles[ray.bundle].members[ray.member]);
    if (outU && inV)
    {
      this->PassEdge(ray, axes.u, axes.v, light.v[ray.channel], tally);
    }
    if (outV && inU)
    {
      this->PassEdge(ray, axes.v, axes.u, light.u[ray.channel], tally);
    }
  }
}

/// Sums the power of a ray that passes an edge of the domain: it enters through the face normal to axis `from` and
/// leaves through the face normal to axis `through`.
/// @param alike  the ray's power from incident light that is uniform over the face, W; it is added only to the sums
///   per cell, because BlockCrossing adds it to the tally
void BlockSweep::ByCells::PassEdge(const Aside& ray, int through, int from, double alike, SweepTally& tally) const
{
  const PlaneAxes& axes = this->Sweep.Plan.axes;
  const Voxel voxel = this->VoxelAt(ray, this->Edge(axes.u, through != axes.u), this->Edge(axes.v, through != axes.v));
  const double power = this->Sweep.Plan.bundleRows[ray.bundle].power;
  const double ofCell = power * this->LightOf(this->EntryFaceOf(from), voxel, ray.channel);
  tally.out[this->EntryFaceOf(through) ^ 1][ray.channel] += 0.5 * ray.part * ofCell;
  if (this->Cells.left)
  {
    this->LeaveThrough(ray, through, voxel, 0.5 * ray.part * (alike + ofCell));
  }
}

/// Adds `power`, which leaves through the face normal to `axis`, to cells of that face. If LightByCells::spreads, a ray
/// nearly parallel to the face represents light that leaves through cells in several planes, and its power is divided
/// among them.
void BlockSweep::ByCells::LeaveThrough(const Aside& ray, int axis, const Voxel& voxel, double power) const
{
  const SweepPlan& plan = this->Sweep.Plan;
  const Bundle& bundle = plan.bundles[ray.bundle];
  const Member& member = bundle.members[ray.member];
  const bool ofU = axis == plan.axes.u ? member.uFromU != 0 : member.vFromU != 0;
  const int march = plan.axes.axis;
  const AsidePlanes planes = { this->Sweep.Whole.size[march], this->Sweep.Periodic[march], this->Cells.spreads };
  ForPlanesPassed(planes, ofU ? bundle.tangentU : bundle.tangentV, voxel[march], [&](int plane, double part) {
    Voxel there = voxel;
    there[march] = plane;
    this->Cells.left[this->CellOf(this->EntryFaceOf(axis) ^ 1, there, ray.channel)] += part * power;
  });
}
}
