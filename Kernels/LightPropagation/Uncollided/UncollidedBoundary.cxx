#include "LightPropagation/Uncollided/UncollidedBoundary.h"

#include "LightPropagation/Sweep/SweepShared.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr std::size_t MostRays = std::size_t(1) << 25; ///< in the maps of a sweep, one way: 128 MiB of floats

/// Rays that move by whole voxels, as straight lines do: moves by parts are there to let in what directions carry, and
/// make paths in the outermost voxels of what shines within another length.
void MoveAsLines(std::vector<Bundle>& bundles)
{
  for (Bundle& bundle : bundles)
  {
    bundle.movesU.clear();
    bundle.movesV.clear();
  }
}
}

SweepTally SweepAlong(const UncollidedVolume& volume, const SweptDirections& along,
  const std::function<bool(int)>& isLit, const Buffer<float>* source, const SweepBoundary& incoming,
  const Monitor& monitor)
{
  const SweepBoundary dark = [](int, int) { return Rgb{}; }; // not none: the maps of the other way are to be empty, too
  const Grid& grid = volume.Whole();
  const int channels = volume.layout.Groups().front().count; // that are swept at once
  AngularValues values;
  volume.Collective([&] { values = volume.basis ? along.Values(*volume.basis) : AngularValues(); });
  SweepTally tally;
  for (int part = 0; part < 6; ++part)
  {
    std::vector<Bundle> bundles;
    volume.Collective([&] { bundles = along.LitAlong(part / 2, part % 2, isLit); });
    if (!incoming)
    {
      MoveAsLines(bundles);
    }
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
      Add(tally, volume.makeSweep(request)->Apply(source, incoming ? incoming : dark, ofSome));
    }
  }
  return tally;
}

UncollidedBoundary::UncollidedBoundary(const PropagationSettings& settings, const BoundaryLight& light)
  : Settings(settings)
  , Light(light)
{
}

SweepTally UncollidedBoundary::AddTo(const UncollidedVolume& volume, const Monitor& monitor) const
{
  const auto isLit = [this](int direction) { return !this->Settings.leaveOut || this->Light.IsLit(direction); };
  return SweepAlong(volume, this->Light.Along(), isLit, nullptr, this->Light.Boundary(), monitor);
}
}
