#include "LightPropagation/Sweep/SweepBorder.h"

#include "Device/HostMemory.h"
#include "Medium/BoxFaces.h"

#include <algorithm>

namespace tyndall
{
std::array<double, 2> SidewaysMoves(const Bundle& bundle, int firstPlane, int planes)
{
  std::array<double, 2> moves = {};
  for (int k = firstPlane; k < firstPlane + planes; ++k)
  {
    const PlaneCrossing crossing = bundle.Crossing(k);
    for (int s = 1; s < crossing.count; ++s)
    {
      moves[0] += crossing.segments[s].part * crossing.segments[s].moveU;
      moves[1] += crossing.segments[s].part * crossing.segments[s].moveV;
    }
  }
  return moves;
}

void CountSideways(const SweepPlan& plan, const std::vector<float>& left, SweepTally& tally)
{
  const std::array<int, 4> faces = { 2 * plan.axes.u, 2 * plan.axes.u + 1, 2 * plan.axes.v, 2 * plan.axes.v + 1 };
  for (std::size_t i = 0; i < left.size(); ++i)
  {
    tally.out[faces[i / plan.channels % 4]][i % plan.channels] += left[i];
  }
}

SweepBorder::SweepBorder(const SweepPlan& plan, const SweepBoundary& boundary, Holds holds)
  : rays(holds == Holds::Maps ? 0 : 2 * plan.eachWay.radiance, cl_float4{})
  , maps(Zeros(holds == Holds::Maps ? 2 * plan.eachWay.maps : 0))
  , outside(holds == Holds::Maps ? 2 * plan.eachWay.outside : 0, 0.0f)
  , radiance(holds == Holds::Maps ? 2 * plan.eachWay.radiance : 0, 0.0f)
  , Plan(plan)
{
  for (std::size_t b = 0; b < plan.bundles.size(); ++b)
  {
    const std::array<double, 2> moves = SidewaysMoves(plan.bundles[b], 0, plan.PatternPlanes());
    for (int way = 0; way < 2; ++way)
    {
      for (int m = 0; m < plan.bundleRows[b].members; ++m)
      {
        this->EnterMember(boundary, b, way, m, moves);
      }
    }
  }
}

/// Writes the incident power of all rays of one bundle member (direction). Rays enter at the face where they start.
/// They also enter through the faces parallel to the marching axis, where as many rays enter as leave: one ray per row
/// of voxels for each move along u, one ray per column for each move along v. If rays move along u and v at once, half
/// of the power that enters at the corner of a plane comes through the face normal to u and half through the face
/// normal to v.
void SweepBorder::EnterMember(
  const SweepBoundary& boundary, std::size_t b, int way, int m, const std::array<double, 2>& moves)
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
    this->powerIn[faceU][c] += moves[swapped ? 1 : 0] * sizeV * u;
    this->powerIn[faceV][c] += moves[swapped ? 0 : 1] * sizeU * v;
  }
}

/// Incident power of one ray that enters through `face`, W per channel.
Rgb SweepBorder::PowerOfRay(const SweepBoundary& boundary, const Bundle& bundle, int direction, int face) const
{
  Rgb values = boundary(direction, face);
  for (double& value : values)
  {
    value *= this->Plan.periodic[face / 2] ? 0.0 : static_cast<float>(bundle.power);
  }
  return values;
}

/// Writes the power of the incident rays of one bundle member and channel, W.
/// @param slot  index within the bundle, [member][channel]
/// @param fromU, fromV, fromP  power of a ray that enters through the face normal to u, v, or the marching axis
void SweepBorder::Write(std::size_t b, int way, int slot, float fromU, float fromV, float fromP)
{
  const BundleInfo& bundle = this->Plan.bundleRows[b];
  if (!this->rays.empty())
  {
    this->rays[way * this->Plan.eachWay.radiance + bundle.border + slot] = { { fromU, fromV, fromP, 0.0f } };
    return;
  }
  const int width = this->Plan.plane.width;
  const std::size_t inBlock = static_cast<std::size_t>(slot) * this->Plan.row + this->Plan.vector;
  const std::size_t block = static_cast<std::size_t>(bundle.members) * this->Plan.channels * this->Plan.row;
  for (int v = 0; v < this->Plan.plane.sizeV + 2; ++v)
  {
    float* map = this->maps.data() + way * this->Plan.eachWay.maps + bundle.map + v * block + inBlock;
    std::fill(map, map + this->Plan.plane.sizeU, fromP);
    std::fill(map + this->Plan.plane.sizeU, map + width, fromU);
  }
  // The columns before and after the row hold the rays that enter at the next move along u, and those that enter
  // through the corner of the plane in a move along u and v at once.
  const bool periodicU = this->Plan.periodic[this->Plan.axes.u];
  const float beside = periodicU ? fromV : fromU;
  float* beyond = this->outside.data() + way * this->Plan.eachWay.outside + bundle.outside + inBlock;
  std::fill(beyond - 1, beyond + width + 1, beside);
  std::fill(beyond, beyond + this->Plan.plane.sizeU, fromV);
  if (!periodicU && this->Plan.bundles[b].MovesBothWaysAtOnce())
  {
    beyond[-1] = beyond[this->Plan.plane.sizeU] = 0.5f * (fromU + fromV);
  }
  this->radiance[way * this->Plan.eachWay.radiance + bundle.border + slot] = fromU;
}
}
