#pragma once

#include "SweepVolume.h"

#include "../Device/Device.h"

#include <array>

namespace tyndall
{
/// How near to voxels' faces the light of beams is lost, told by the faces that it enters through: beams are swept on their own, then
/// added to what the others gathered.
class BeamNearness
{
public:
  /// Of parallel beams, or all in one octant of directions: for them the sweep finds the net flux too.
  enum class Kind
  {
    Parallel,
    Octant
  };

  /// @param volume  with nearness; must stay
  BeamNearness(Device& device, const SweepVolume& volume, Kind kind);

  const SweepVolume& Own() const { return this->OfBeams; } ///< sweep this one

  /// Path and nearness (and net flux) are added to those of the volume.
  /// @param omega  the way the light travels; of an octant the signs count
  void Add(const std::array<double, 3>& omega, const std::array<bool, 3>& periodic);

private:
  Device& TheDevice;
  const SweepVolume& Volume;
  Kind TheKind;
  SweepVolume OfBeams;
  Buffer<float> Path, Entering, Flux;
};
}
