#include "LightPropagation/Sweep/SweepBorder.h"

#include "Device/HostMemory.h"
#include "Medium/BoxFaces.h"

#include <algorithm>

namespace tyndall
{
SweepBorder::SweepBorder(const SweepPlan& plan, const SweepBoundary& boundary, Holds holds)
  : rays(holds == Holds::Maps ? 0 : 2 * plan.radianceEachWay, cl_float4{})
  , maps(Zeros(holds == Holds::Maps ? 2 * plan.mapsEachWay : 0))
  , outside(holds == Holds::Maps ? 2 * plan.outsideEachWay : 0, 0.0f)
  , radiance(holds == Holds::Maps ? 2 * plan.radianceEachWay : 0, 0.0f)
  , Plan(plan)
{
  for (std::size_t b = 0; b < plan.bundles.size(); ++b)
  {
    const Moves moves = this->MovesOf(plan.bundles[b]);
    for (int way = 0; way < 2; ++way)
    {
      for (int m = 0; m < plan.bundleRows[b].members; ++m)
      {
        this->EnterMember(boundary, b, way, m, moves);
      }
    }
  }
}

SweepBorder::Moves SweepBorder::MovesOf(const Bundle& bundle) const
{
  Moves moves;
  for (int k = 0; k < this->Plan.PatternPlanes(); ++k)
  {
    const PlaneCrossing crossing = bundle.Crossing(k);
    for (int s = 1; s < crossing.count; ++s)
    {
      moves.u += crossing.segments[s].part * crossing.segments[s].moveU;
      moves.v += crossing.segments[s].part * crossing.segments[s].moveV;
    }
  }
  return moves;
}

/// Rays enter where they start, and in place of rays that left sideways: one per row for each move along u, one per
/// column for each move along v. Of the rays that move along u and v at once and enter at the plane's corner, half
/// enter through u's face and half through v's.
void SweepBorder::EnterMember(const SweepBoundary& boundary, std::size_t b, int way, int m, const Moves& moves)
{
  const Bundle& bundle = this->Plan.bundles[b];
  const Member& member = bundle.members[m];
  const int direction = way == 0 ? member.direction : member.opposite;
  if (direction < 0)
  {
    return;
  }
  const PlaneAxes& axes = this->Plan.axes;
  const int faceU = EntryFace(axes.u, member.uFromU + member.uFromV > 0);
  const int faceV = EntryFace(axes.v, member.vFromU + member.vFromV > 0);
  const int faceP = 2 * axes.axis + way;
  const Rgb fromU = this->PowerOfRay(boundary, bundle, direction, faceU);
  const Rgb fromV = this->PowerOfRay(boundary, bundle, direction, faceV);
  const Rgb fromP = this->PowerOfRay(boundary, bundle, direction, faceP);
  const bool swapped = member.uFromU == 0;
  const double sizeU = this->Plan.plane.sizeU;
  const double sizeV = this->Plan.plane.sizeV;
  for (int c = 0; c < this->Plan.channels; ++c)
  {
    const float u = static_cast<float>(fromU[c]);
    const float v = static_cast<float>(fromV[c]);
    const float p = static_cast<float>(fromP[c]);
    this->Write(b, way, m * this->Plan.channels + c, u, v, p);
    this->powerIn[faceP][c] += p * sizeU * sizeV;
    this->powerIn[faceU][c] += (swapped ? moves.v : moves.u) * sizeV * u;
    this->powerIn[faceV][c] += (swapped ? moves.u : moves.v) * sizeU * v;
  }
}

/// Incident power of a ray, W per channel.
Rgb SweepBorder::PowerOfRay(const SweepBoundary& boundary, const Bundle& bundle, int direction, int face) const
{
  Rgb values = boundary(direction, face);
  for (double& value : values)
  {
    value *= this->Plan.periodic[face / 2] ? 0.0 : static_cast<float>(bundle.power);
  }
  return values;
}

/// @param slot  index within the bundle, [member][channel]
void SweepBorder::Write(std::size_t b, int way, int slot, float fromU, float fromV, float fromP)
{
  const BundleInfo& bundle = this->Plan.bundleRows[b];
  if (!this->rays.empty())
  {
    this->rays[way * this->Plan.radianceEachWay + bundle.border + slot] = { { fromU, fromV, fromP, 0.0f } };
    return;
  }
  const int width = this->Plan.plane.width;
  const std::size_t inBlock = static_cast<std::size_t>(slot) * this->Plan.row + this->Plan.vector;
  const std::size_t block = static_cast<std::size_t>(bundle.members) * this->Plan.channels * this->Plan.row;
  for (int v = 0; v < this->Plan.plane.sizeV + 2; ++v)
  {
    float* map = this->maps.data() + way * this->Plan.mapsEachWay + bundle.map + v * block + inBlock;
    std::fill(map, map + this->Plan.plane.sizeU, fromP);
    std::fill(map + this->Plan.plane.sizeU, map + width, fromU);
  }
  // The columns beside it hold rays that enter at the next move along u, as in the map. Rays that move along u and v at
  // once come from these columns.
  const bool periodicU = this->Plan.periodic[this->Plan.axes.u];
  const float beside = periodicU ? fromV : fromU;
  float* beyond = this->outside.data() + way * this->Plan.outsideEachWay + bundle.outside + inBlock;
  std::fill(beyond - 1, beyond + width + 1, beside);
  std::fill(beyond, beyond + this->Plan.plane.sizeU, fromV);
  if (!periodicU && this->Plan.bundles[b].MovesBothWaysAtOnce())
  {
    beyond[-1] = beyond[this->Plan.plane.sizeU] = 0.5f * (fromU + fromV);
  }
  this->radiance[way * this->Plan.radianceEachWay + bundle.border + slot] = fromU;
}
}
