#include "LightPropagation/Uncollided/UncollidedBoundary.h"

#include "LightPropagation/Sweep/SweepShared.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Rays in the maps of a sweep for one marching direction: 128 MiB of floats.
constexpr std::size_t MostRays = std::size_t(1) << 25;

/// Makes rays cross whole voxels, as straight lines do. Fractional moves serve to let in the power of boundary sources;
/// in an emitting medium they would change path lengths in the outermost emitting voxels.
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
  // a function rather than none: the maps of the opposite marching direction must be cleared, too
  const SweepBoundary dark = [](int, int) { return Rgb{}; };
  const Grid& grid = volume.domain.Whole();
  const int channels = volume.layout.Groups().front().count; // number of channels that are swept together
  AngularValues values;
  volume.domain.Collective([&] { values = volume.basis ? along.Values(*volume.basis) : AngularValues(); });
  SweepTally tally;
  for (int part = 0; part < 6; ++part)
  {
    std::vector<Bundle> bundles;
    volume.domain.Collective([&] { bundles = along.LitAlong(part / 2, part % 2, isLit); });
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
