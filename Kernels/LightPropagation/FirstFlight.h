#pragma once

#include "NeededRays.h"
#include "PropagationSettings.h"
#include "SweepVolume.h"

#include "../Device/Monitor.h"
#include "../Lights/Lights.h"

#include <vector>

namespace tyndall
{
/// The first-collision source of shining faces, sky and environment: their unscattered light, from where it comes in to where it
/// first meets the medium, along directions of its own. Shadows have edges, which want many directions; scattered light is
/// smooth and does with few, so that the many are swept once and not once an order.
///
/// What comes in evenly from everywhere is not its business: in a medium that only scatters, unscattered and scattered light
/// then add up to the same radiance everywhere, and do so in a solver only along the same directions.
class FirstFlight
{
public:
  /// @param directions  `settings.firstFlightDirections` a face; must stay
  /// @param farAway  environment without its peaks; faces and sky are those of `illumination`
  FirstFlight(const Grid& grid, const PropagationSettings& settings, const DirectionSet& directions,
    const Illumination& illumination, const Environment& farAway);

  /// Radiance that comes in along every direction through every open face, and is left to others. W / (length^2 sr)
  const Rgb& Even() const { return this->EvenPart; }
  bool Shines() const { return this->AnyLight; } ///< there is more than that
  Rgb PowerIn() const;                           ///< W through the box's faces, were there rays everywhere

  /// Adds its light to path, and what else the volume asks for; with `nearness`, octant by octant, so that light has one way
  /// along every axis (as a beam, see BeamNearness.cl).
  /// @param firstChannel  of the three, that is the volume's first
  /// @param workspace  of sweeps that are not under way
  /// @return what came in, what left, what still goes round a periodic axis
  SweepTally Deposit(
    Device& device, const SweepVolume& volume, int firstChannel, SweepWorkspace& workspace, const Monitor& monitor) const;

private:
  /// Bundles of one axis that march one way and come from one octant, or any.
  struct Part
  {
    int axis = 0, way = 0;
    int octant = -1; ///< bit a: upwards along axis a
  };
  Rgb Incoming(int direction, int face) const;
  bool IsLit(int direction) const;
  bool IsOf(const Part& part, int direction) const;
  SweepTally Sweep(Device& device, const SweepVolume& volume, int firstChannel, const Part& part,
    SweepWorkspace& workspace, const Monitor& monitor) const;
  SweepTally SweepOctant(Device& device, const SweepVolume& volume, int firstChannel, int octant,
    SweepWorkspace& workspace, const Monitor& monitor) const;

  Grid TheGrid;
  const PropagationSettings& Settings;
  const DirectionSet& Directions;
  MirrorClasses Mirrors;
  bool MergesMirrors;
  std::array<Rgb, 6> Faces;
  std::vector<Rgb> FromFarAway; ///< by direction, in the mean over those that it stands for
  Rgb EvenPart = {};
  bool AnyLight = false;
};
}
