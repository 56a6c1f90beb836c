#pragma once

#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Uncollided/LampOnGrid.h"

namespace tyndall
{
/// What a lamp's beams put down, parts of its power in 64-bit fixed point, so that sums do not depend on the order of
/// their terms (numerics.md, Eq. (35)): path times length, and behind it first moments and net flux where a deposit
/// asks for them, [path, 3 first moments, 3 of flux][stride].
class LampSums
{
public:
  /// @param stride  voxels of an array
  LampSums(Device& device, const Deposit& deposit, std::size_t stride);

  static int Parts(const Deposit& deposit) { return 1 + (deposit.firstMoments ? 3 : 0) + (deposit.flux ? 3 : 0); }

  Buffer<cl_long>& Sums() { return this->Fixed; }
  std::size_t Stride() const { return this->TheStride; }

  /// Adds what is there, times the lamp's power, to the deposit's arrays.
  /// @param volume  its stride is that of the sums
  /// @param factor  of the lamp's power
  void AddTo(const SweepVolume& volume, const LampOnGrid& lamp, double factor) const;

private:
  Device& TheDevice;
  Buffer<cl_long> Fixed;
  std::size_t TheStride;
};
}
