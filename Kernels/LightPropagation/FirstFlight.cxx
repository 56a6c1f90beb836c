#include "FirstFlight.h"

#include "AxisSweep.h"
#include "SweepPlan.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tyndall
{
namespace
{
constexpr int ManyPlanes = 8192;                       ///< that a ray goes round a periodic axis before it is given up
constexpr double Rounding = 1e-6;                      ///< of radiance that is meant to be even
constexpr std::size_t MostRays = std::size_t(1) << 25; ///< in the maps of a sweep, one way: 128 MiB of floats

/// Through which face light of that way along the axis comes in.
int FaceOf(int axis, bool upwards)
{
  return 2 * axis + (upwards ? 0 : 1);
}
}

FirstFlight::FirstFlight(const Grid& grid, const PropagationSettings& settings, const DirectionSet& directions,
  RayStarts starts, const Illumination& illumination, const Environment& farAway)
  : TheGrid(grid)
  , Settings(settings)
  , Directions(directions)
  , Starts(starts)
  , Mirrors(grid, settings.periodic, directions)
  , MergesMirrors(settings.leaveOut && !settings.netFlux)
  , Faces(illumination.faces)
  , FromFarAway(directions.directions.size())
{
  const std::vector<Rgb> radiance = BoundaryRadiance(directions, farAway, illumination.sky);
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
  this->FindRange();
}

void FirstFlight::FindRange()
{
  Rgb least, most = {};
  least.fill(std::numeric_limits<double>::max());
  for (std::size_t d = 0; d < this->FromFarAway.size(); ++d)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const Rgb in =
        this->Incoming(static_cast<int>(d), FaceOf(axis, this->Directions.directions[d].omega[axis] > 0.0));
      for (int c = 0; c < 3 && !this->Settings.periodic[axis]; ++c)
      {
        least[c] = std::min(least[c], in[c]);
        most[c] = std::max(most[c], in[c]);
      }
    }
  }
  for (int c = 0; c < 3; ++c)
  {
    this->AnyLight = this->AnyLight || most[c] > 0.0;
    this->AllAlike = this->AllAlike && (most[c] <= 0.0 || most[c] - least[c] <= Rounding * most[c]);
  }
}

Rgb FirstFlight::Incoming(int direction, int face) const
{
  Rgb radiance = this->Faces[face];
  for (int c = 0; c < 3; ++c)
  {
    radiance[c] += this->FromFarAway[direction][c];
  }
  return radiance;
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

/// Those that march one way along the axis.
std::vector<Bundle> FirstFlight::LitBundles(int axis, int way) const
{
  std::vector<Bundle> bundles =
    BundlesAlong(axis, this->TheGrid, this->Settings.periodic, this->Directions, this->Settings.mapResolution,
      this->Starts);
  if (this->MergesMirrors)
  {
    bundles = this->Mirrors.Standing(bundles);
  }
  return LitRays(bundles, way, [this](int direction) { return this->IsLit(direction); });
}

SweepTally FirstFlight::Deposit(
  Device& device, const SweepVolume& volume, int firstChannel, SweepWorkspace& workspace, const Monitor& monitor) const
{
  const auto incoming = [&](int direction, int face) { return From(this->Incoming(direction, face), firstChannel); };
  SweepTally tally;
  for (int part = 0; part < 6; ++part)
  {
    const Monitor ofPart = monitor ? Monitor([&](double done) { return monitor((part + done) / 6.0); }) : Monitor();
    const std::vector<Bundle> bundles = this->LitBundles(part / 2, part % 2);
    const PlaneAxes axes = AcrossAxis(part / 2);
    const std::size_t plane = static_cast<std::size_t>(volume.grid.size[axes.u]) * volume.grid.size[axes.v];
    const std::size_t most = std::max<std::size_t>(MostRays / (MaxMembers * plane * volume.channels), 8);
    for (std::size_t first = 0; first < bundles.size(); first += most)
    {
      const std::vector<Bundle> some(bundles.begin() + first, bundles.begin() + std::min(first + most, bundles.size()));
      AxisSweep sweep(device, volume, part / 2, some, this->Settings.periodic, workspace);
      sweep.Start(volume, incoming, false, ManyPlanes, ofPart);
      Add(tally, sweep.Finish());
    }
  }
  return tally;
}
}
