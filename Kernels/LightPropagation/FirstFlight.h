#pragma once

#include "NeededRays.h"
#include "PropagationSettings.h"
#include "SweepVolume.h"

#include "../Device/Monitor.h"
#include "../Lights/Lights.h"

#include <vector>

namespace tyndall
{
/// The unscattered light of shining faces, sky and environment, from where it comes in to where it first meets the medium, along a set
/// of directions. Shadows have edges, which want many directions; scattered light is smooth and does with few: so the many
/// are swept once and not once an order.
class FirstFlight
{
public:
  /// @param settings, directions  must stay
  /// @param illumination  its faces and sky
  /// @param farAway  its environment without peaks
  FirstFlight(const Grid& grid, const PropagationSettings& settings, const DirectionSet& directions, RayStarts starts,
    const Illumination& illumination, const Environment& farAway);

  bool Shines() const { return this->AnyLight; }
  bool IsEven() const { return this->AllAlike; } ///< the same comes in along every direction through every open face
  /// Radiance, in the mean over the directions that this one stands for. W / (length^2 sr)
  Rgb Incoming(int direction, int face) const;

  /// Adds its light to the volume's path, and to its flux where that is wanted.
  /// @param firstChannel  of the three, that is the volume's first
  /// @param workspace  of sweeps that are not under way
  /// @return what came in, what left, what still goes round a periodic axis
  SweepTally Deposit(Device& device, const SweepVolume& volume, int firstChannel, SweepWorkspace& workspace,
    const Monitor& monitor) const;

private:
  void FindRange();
  bool IsLit(int direction) const;
  std::vector<Bundle> LitBundles(int axis, int way) const;

  Grid TheGrid;
  const PropagationSettings& Settings;
  const DirectionSet& Directions;
  RayStarts Starts;
  MirrorClasses Mirrors;
  bool MergesMirrors;
  std::array<Rgb, 6> Faces;
  std::vector<Rgb> FromFarAway; ///< by direction, in the mean over those that it stands for
  bool AnyLight = false;
  bool AllAlike = true;
};
}
