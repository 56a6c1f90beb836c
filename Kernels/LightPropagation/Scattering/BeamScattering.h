#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Angular/AngularBasis.h"
#include "PhaseFunction/PhaseFunction.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// First-collision source of a parallel beam along each direction of a quadrature, minus its truncated angular moments
/// in `basis`, normalised to scattered light with a mean of 1 over all directions (numerics.md, Eqs. (42b), (42c)).
/// Truncated moments of a forward peak are negative sideways; the phase function without its peak is not. The peak
/// removed is the part of the phase function above some level around the forward direction, with as much power as
/// delta-M treats as unscattered.
///
/// All moments of the result in `basis` are zero to rounding, so the moments of the scattered light do not change.
std::vector<double> BeyondMoments(const PhaseFunction& function, const DeltaM& truncated, const DirectionSet& set,
  const AngularBasis& basis, const std::array<double, 3>& beam);

/// The same if the moments are smoothed so that the source is nowhere negative (WithoutNegatives): the complete
/// first-collision source of the beam minus its smoothed moments. The source along each direction then follows the
/// phase function, with the mean cosine of the moments; its higher moments differ from theirs.
std::vector<double> BeyondSmoothMoments(const PhaseFunction& function, const DeltaM& truncated, const DirectionSet& set,
  const AngularBasis& basis, const std::array<double, 3>& beam);

/// First-collision sources of beams, stored in a source array after its angular moments. They are emitted once: not in
/// the sweep during which the beams were traced, but in the next one.
class BeamsInSource
{
public:
  /// @param source  must outlive this
  /// @param first, count  index range of the beams in the source array
  BeamsInSource(Device& device, Buffer<float>& source, std::size_t first, std::size_t count)
    : TheDevice(device)
    , Source(source)
    , First(first)
    , Count(count)
  {
  }

  /// Moves the sources of the beams out of the array. Call before the sweep of the same order.
  void Hold();
  /// Restores them for the next sweep; if already restored, sets them to 0. Call after each sweep.
  void GoOn();

private:
  Device& TheDevice;
  Buffer<float>& Source;
  std::size_t First, Count;
  Buffer<float> Held;
};
}
