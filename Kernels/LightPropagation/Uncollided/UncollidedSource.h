#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LightPropagation/Sweep/SweepVolume.h"

namespace tyndall
{
/// Light up to where it first meets the medium: the uncollided flux of one lamp, of all that shines through the box's
/// faces, of a small bright part of the medium (numerics.md, section 5). Found once a solve; what of it is scattered is
/// the first source.
class UncollidedSource
{
public:
  virtual ~UncollidedSource() = default;

  /// Adds its path integrals, and flux and moments where the deposit has arrays for them, to the volume's deposit.
  /// @param firstChannel  of the light's three, that is the volume's first
  /// @param workspace  of sweeps that are not under way
  /// @return what came in, what left, what still goes round a periodic axis
  virtual SweepTally AddTo(Device& device, const SweepVolume& volume, int firstChannel, SweepWorkspace& workspace,
    const Monitor& monitor) const = 0;
};
}
