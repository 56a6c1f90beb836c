#include "LightPropagation/Uncollided/UncollidedBoundary.h"

#include "LightPropagation/Sweep/AxisSweep.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepPlan.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr std::size_t MostRays = std::size_t(1) << 25; ///< in the maps of a sweep, one way: 128 MiB of floats
}

UncollidedBoundary::UncollidedBoundary(const PropagationSettings& settings, const BoundaryLight& light)
  : Settings(settings)
  , Light(light)
{
}

SweepTally UncollidedBoundary::AddTo(
  Device& device, const SweepVolume& volume, int firstChannel, SweepWorkspace& workspace, const Monitor& monitor) const
{
  const auto incoming = [&](int direction, int face) {
    return From(this->Light.Incoming(direction, face), firstChannel);
  };
  const auto isLit = [&](int direction) { return !this->Settings.leaveOut || this->Light.IsLit(direction); };
  SweepTally tally;
  for (int part = 0; part < 6; ++part)
  {
    const Monitor ofPart = OfPart(monitor, [=](double done) { return (part + done) / 6.0; });
    const std::vector<Bundle> bundles = this->Light.Along().LitAlong(part / 2, part % 2, isLit);
    const PlaneAxes axes = AcrossAxis(part / 2);
    const std::size_t plane = static_cast<std::size_t>(volume.grid.size[axes.u]) * volume.grid.size[axes.v];
    const std::size_t most = std::max<std::size_t>(MostRays / (MaxMembers * plane * volume.channels), 8);
    for (std::size_t first = 0; first < bundles.size(); first += most)
    {
      const std::vector<Bundle> some(bundles.begin() + first, bundles.begin() + std::min(first + most, bundles.size()));
      AxisSweep sweep(device, volume, part / 2, some, this->Settings.periodic, workspace);
      sweep.Start(volume, incoming, false, MostPlanesAround, ofPart);
      Add(tally, sweep.Finish());
    }
  }
  return tally;
}
}
