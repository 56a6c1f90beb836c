#include "FirstFlight.h"

#include "AxisSweep.h"
#include "BeamNearness.h"
#include "SweepPlan.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tyndall
{
namespace
{
constexpr int ManyPlanes = 8192; ///< that a ray goes round a periodic axis before it is given up
constexpr std::size_t MostRays = std::size_t(1) << 25; ///< in the maps of a sweep, one way: 128 MiB of floats

/// Through which face light of that way along the axis comes in.
int FaceOf(int axis, bool upwards)
{
  return 2 * axis + (upwards ? 0 : 1);
}

void Add(SweepTally& sum, const SweepTally& tally)
{
  for (int c = 0; c < 3; ++c)
  {
    for (int face = 0; face < 6; ++face)
    {
      sum.in[face][c] += tally.in[face][c];
      sum.out[face][c] += tally.out[face][c];
    }
    sum.onTheWay[c] += tally.onTheWay[c];
  }
}

double FaceArea(const Grid& grid, int axis)
{
  return grid.Length((axis + 1) % 3) * grid.Length((axis + 2) % 3);
}
}

FirstFlight::FirstFlight(const Grid& grid, const PropagationSettings& settings, const DirectionSet& directions,
  const Illumination& illumination, const Environment& farAway)
  : TheGrid(grid)
  , Settings(settings)
  , Directions(directions)
  , Mirrors(grid, settings.periodic, directions)
  , MergesMirrors(settings.leaveOut && !settings.netFlux)
  , Faces(illumination.faces)
{
  const std::vector<Rgb> radiance = BoundaryRadiance(directions, farAway, illumination.sky);
  this->FromFarAway.assign(radiance.size(), {});
  for (std::size_t d = 0; d < radiance.size(); ++d)
  {
    const std::vector<int> itself = { static_cast<int>(d) };
    const std::vector<int>& all = this->MergesMirrors ? this->Mirrors.AllOf(static_cast<int>(d)) : itself;
    for (const int one : all)
    {
      for (int c = 0; c < 3; ++c)
      {
        this->FromFarAway[d][c] += radiance[one][c] / static_cast<double>(all.size());
      }
    }
  }
  Rgb least, most = {};
  least.fill(std::numeric_limits<double>::max());
  for (std::size_t d = 0; d < radiance.size(); ++d)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const Rgb in =
        this->Incoming(static_cast<int>(d), FaceOf(axis, this->Directions.directions[d].omega[axis] > 0.0));
      for (int c = 0; c < 3 && !settings.periodic[axis]; ++c)
      {
        least[c] = std::min(least[c], in[c]);
        most[c] = std::max(most[c], in[c]);
      }
    }
  }
  for (int c = 0; c < 3; ++c)
  {
    const bool even = most[c] - least[c] <= 1e-6 * most[c]; // rounding
    this->AnyLight = this->AnyLight || !even;
    this->EvenPart[c] = even ? most[c] : least[c];
  }
}

/// Radiance but for the even part.
Rgb FirstFlight::Incoming(int direction, int face) const
{
  Rgb radiance = this->Faces[face];
  for (int c = 0; c < 3; ++c)
  {
    radiance[c] = std::max(radiance[c] + this->FromFarAway[direction][c] - this->EvenPart[c], 0.0);
  }
  return radiance;
}

Rgb FirstFlight::PowerIn() const
{
  Rgb power = {};
  for (std::size_t d = 0; d < this->Directions.directions.size(); ++d)
  {
    const Direction& direction = this->Directions.directions[d];
    for (int axis = 0; axis < 3; ++axis)
    {
      const Rgb radiance = this->Incoming(static_cast<int>(d), FaceOf(axis, direction.omega[axis] > 0.0));
      const double area = this->Settings.periodic[axis] ? 0.0 : FaceArea(this->TheGrid, axis);
      for (int c = 0; c < 3; ++c)
      {
        power[c] += direction.weight * std::abs(direction.omega[axis]) * area * radiance[c];
      }
    }
  }
  return power;
}

bool FirstFlight::IsLit(int direction) const
{
  bool lit = !this->Settings.leaveOut;
  for (int axis = 0; axis < 3; ++axis)
  {
    const Rgb in = this->Incoming(direction, FaceOf(axis, this->Directions.directions[direction].omega[axis] > 0.0));
    lit = lit || (!this->Settings.periodic[axis] && in[0] + in[1] + in[2] > 0.0);
  }
  return lit;
}

bool FirstFlight::IsOf(const Part& part, int direction) const
{
  bool of = true;
  for (int axis = 0; axis < 3 && part.octant >= 0; ++axis)
  {
    const bool upwards = this->Directions.directions[direction].omega[axis] > 0.0;
    of = of && upwards == ((part.octant >> axis & 1) != 0);
  }
  return of && this->IsLit(direction);
}

SweepTally FirstFlight::Sweep(Device& device, const SweepVolume& volume, int firstChannel, const Part& part,
  SweepWorkspace& workspace, const Monitor& monitor) const
{
  std::vector<Bundle> bundles =
    BundlesAlong(part.axis, this->TheGrid, this->Directions, this->Settings.mapResolution);
  if (this->MergesMirrors)
  {
    bundles = this->Mirrors.Standing(bundles);
  }
  bundles = LitRays(bundles, part.way, [&](int direction) { return this->IsOf(part, direction); });
  const PlaneAxes axes = AcrossAxis(part.axis);
  const std::size_t plane = static_cast<std::size_t>(volume.grid.size[axes.u]) * volume.grid.size[axes.v];
  const std::size_t most = std::max<std::size_t>(MostRays / (MaxMembers * plane * volume.channels), 8);
  SweepTally tally;
  for (std::size_t first = 0; first < bundles.size(); first += most)
  {
    const auto end = bundles.begin() + static_cast<std::ptrdiff_t>(std::min(first + most, bundles.size()));
    AxisSweep sweep(device, volume, part.axis,
      std::vector<Bundle>(bundles.begin() + static_cast<std::ptrdiff_t>(first), end), this->Settings.periodic,
      workspace);
    const auto incoming = [&](int direction, int face) { return From(this->Incoming(direction, face), firstChannel); };
    sweep.Start(volume, incoming, false, ManyPlanes, monitor);
    Add(tally, sweep.Finish());
  }
  return tally;
}

SweepTally FirstFlight::SweepOctant(Device& device, const SweepVolume& volume, int firstChannel, int octant,
  SweepWorkspace& workspace, const Monitor& monitor) const
{
  const std::array<bool, 3> up = { (octant & 1) != 0, (octant & 2) != 0, (octant & 4) != 0 };
  BeamNearness nearness(device, volume, BeamNearness::Kind::Octant);
  SweepTally tally;
  for (int axis = 0; axis < 3; ++axis)
  {
    const Part part = { axis, up[axis] ? 0 : 1, octant };
    Add(tally, this->Sweep(device, nearness.Own(), firstChannel, part, workspace, monitor));
  }
  nearness.Add({ up[0] ? 1.0 : -1.0, up[1] ? 1.0 : -1.0, up[2] ? 1.0 : -1.0 }, this->Settings.periodic);
  return tally;
}

SweepTally FirstFlight::Deposit(
  Device& device, const SweepVolume& volume, int firstChannel, SweepWorkspace& workspace, const Monitor& monitor) const
{
  SweepTally tally;
  const int parts = volume.nearness ? 8 : 6;
  for (int p = 0; p < parts; ++p)
  {
    const Monitor ofPart = monitor ? Monitor([&](double done) { return monitor((p + done) / parts); }) : Monitor();
    Add(tally,
      volume.nearness
        ? this->SweepOctant(device, volume, firstChannel, p, workspace, ofPart)
        : this->Sweep(device, volume, firstChannel, { p / 2, p % 2, -1 }, workspace, ofPart));
  }
  return tally;
}
}
