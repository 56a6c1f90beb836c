#include "LightPropagation/Uncollided/UncollidedBoundary.h"

#include "LightPropagation/Sweep/SweepShared.h"

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

SweepTally UncollidedBoundary::AddTo(const UncollidedVolume& volume, const Monitor& monitor) const
{
  const Grid& grid = volume.Whole();
  const int channels = volume.layout.Groups().front().count; // that are swept at once
  const SweepBoundary incoming = this->Light.Boundary();
  const auto isLit = [&](int direction) { return !this->Settings.leaveOut || this->Light.IsLit(direction); };
  AngularValues values;
  volume.Together([&] { values = volume.basis ? this->Light.Along().Values(*volume.basis) : AngularValues(); });
  SweepTally tally;
  for (int part = 0; part < 6; ++part)
  {
    std::vector<Bundle> bundles;
    volume.Together([&] { bundles = this->Light.Along().LitAlong(part / 2, part % 2, isLit); });
    const PlaneAxes axes = AcrossAxis(part / 2);
    const std::size_t plane = static_cast<std::size_t>(grid.size[axes.u]) * grid.size[axes.v];
    const std::size_t most = std::max<std::size_t>(MostRays / (MaxMembers * plane * channels), 8);
    for (std::size_t first = 0; first < bundles.size(); first += most)
    {
      const std::vector<Bundle> some(bundles.begin() + first, bundles.begin() + std::min(first + most, bundles.size()));
      const double all = 6.0 * static_cast<double>(bundles.size());
      const double before = part / 6.0 + static_cast<double>(first) / all;
      const Monitor ofSome = OfPart(monitor, before, before + static_cast<double>(some.size()) / all);
      SweepRequest request = { volume.deposit, { { part / 2, some } } };
      request.angular = volume.basis ? &values : nullptr;
      Add(tally, volume.makeSweep(request)->Apply(nullptr, incoming, ofSome));
    }
  }
  return tally;
}
}
