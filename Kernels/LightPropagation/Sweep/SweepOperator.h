#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "LightPropagation/Sweep/SweepVolume.h"

namespace tyndall
{
/// Carries light once through the medium: from what shines in its voxels and what comes in through the box's faces to
/// path integrals, net flux, partial currents and the power that left (numerics.md, section 4). Power is conserved,
/// Eq. (27). Independent of scattering orders and of acceleration. In one device's memory today
/// (SweepInMemory.h); by slices, over several machines or in another order are further implementations.
class SweepOperator
{
public:
  virtual ~SweepOperator() = default;

  /// Adds to the deposit that the operator was made with.
  /// @param source  W / (length^3 sr), [channel][stride]; null: the medium is dark
  /// @param boundary  what comes in, three channels; empty: nothing
  /// @param monitor  given fractions of this sweep
  /// @return of all channels: what came in, what left, what still goes round a periodic axis and does so in the next
  /// sweep
  virtual SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) = 0;

  /// Light on its way round periodic axes is given up.
  virtual void Forget() = 0;
};
}
