#pragma once

#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "Lights/Lights.h"

#include <array>
#include <utility>
#include <vector>

namespace tyndall
{
/// Light that comes from outside: of shining faces, of the sky and of the environment (but its peaks, which are lamps),
/// along a set of directions (numerics.md, Eq. (31)).
class BoundaryLight
{
public:
  /// @param directions  must stay
  /// @param farAway  the illumination's environment without peaks
  BoundaryLight(const Grid& grid, const PropagationSettings& settings, const SweptDirections& directions,
    const Illumination& illumination, const Environment& farAway);

  bool Shines() const { return this->AnyLight; }
  bool IsEven() const { return this->AllAlike; } ///< the same comes in along every direction through every open face
  bool IsLit(int direction) const;               ///< light comes in along it through one of the open faces
  /// Radiance, in the mean over the directions that this one stands for. W / (length^2 sr)
  Rgb Incoming(int direction, int face) const;
  SweepBoundary Boundary() const; ///< the same, for a sweep; this must stay
  /// W / length^2 through each of the box's faces; 0 where the axis is periodic.
  std::array<Rgb, 6> IncomingPower() const;

  /// Rays that enter a face aside of their marching axis are few where the box has few of that axis' planes.
  /// @param channels  that are looked at
  /// @throws InvalidInput where so few of them meet the faces that shine that whole rays would miss 30% of the power
  void CheckRays(int channels) const;
  /// CheckRays would not throw, whichever of the box's open faces shines.
  static bool HasEnoughRays(const Grid& grid, const PropagationSettings& settings, const SweptDirections& directions);

  const SweptDirections& Along() const { return this->Directions; }

private:
  void FindRange();
  std::pair<Rgb, Rgb> EnteringPower() const;

  Grid TheGrid;
  std::array<bool, 3> Periodic;
  int MapResolution;
  const SweptDirections& Directions;
  std::array<Rgb, 6> Faces;
  std::vector<Rgb> FromFarAway; ///< by direction, in the mean over those that it stands for
  bool AnyLight = false;
  bool AllAlike = true;
};
}
