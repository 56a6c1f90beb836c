#pragma once

#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"
#include "Lights/Lights.h"

#include <array>
#include <functional>
#include <utility>
#include <vector>

namespace tyndall
{
/// Boundary source along a set of directions (numerics.md, Eq. (31)). Its radiance is the sum of the emission of the
/// faces, the sky and the environment. The peaks of the environment are excluded; they are treated as lamps
/// (EnvironmentPeaks.h).
class BoundaryLight
{
public:
  /// @param directions  quadrature; must outlive this object
  /// @param farAway  environment of the illumination, without its peaks
  BoundaryLight(const Grid& grid, const PropagationSettings& settings, const SweptDirections& directions,
    const Illumination& illumination, const Environment& farAway);

  bool Shines() const { return this->AnyLight; }
  /// Whether the incident radiance is the same for all directions and all non-periodic faces.
  bool IsEven() const { return this->AllAlike; }
  bool IsLit(int direction) const; ///< whether the direction has incident radiance on a non-periodic face
  /// Incident radiance through `face`, W / (length^2 sr), averaged over the directions that `direction` represents.
  Rgb Incoming(int direction, int face) const { return this->Faces[face] + this->FromFarAway[direction]; }
  /// Boundary source of a sweep: Incoming() as a function object, which this object must outlive
  SweepBoundary Boundary() const;
  /// Incident power per area through each of the box's faces, W / length^2; 0 where the axis is periodic.
  std::array<Rgb, 6> IncomingPower() const;

  /// Checks that a sweep without fractional moves (moves of only a part of a ray's power) would carry enough of the
  /// incident power. If the box has few planes of voxels along a marching axis, few rays enter through the faces
  /// parallel to that axis.
  /// @param channels  number of channels to check
  /// @throws InvalidInput if rays without fractional moves would miss more than 30% of the power that enters through
  /// the emitting faces
  void CheckRays(int channels) const;
  /// Whether CheckRays() would pass for emission by any of the non-periodic faces.
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
  /// Radiance of sky and environment along each direction of the quadrature, W / (length^2 sr): the mean over all
  /// directions that this direction represents.
  std::vector<Rgb> FromFarAway;
  bool AnyLight = false;
  bool AllAlike = true;
};

/// Sweeps once along the directions of a quadrature that may differ from that of the scattered light. Sweeps in batches
/// of directions whose rays fit into memory. Adds to the volume's deposit. Collective if the domain is divided into
/// blocks.
/// @param isLit  whether a direction carries any light
/// @param source  W / (length^3 sr), as for SweepOperator, with its angular moments in the volume's basis if there is
///   one; null: no emission
/// @param incoming  boundary source; empty: no incident light, and rays then move without fractional moves
SweepTally SweepAlong(const UncollidedVolume& volume, const SweptDirections& along,
  const std::function<bool(int)>& isLit, const Buffer<float>* source, const SweepBoundary& incoming,
  const Monitor& monitor);

/// Uncollided flux of emitting faces, sky and environment, from one sweep along a finer quadrature than that of
/// scattered light. Uncollided light has shadow edges, which need many directions. Scattered light is smooth and needs
/// few directions, but is swept in every iteration.
class UncollidedBoundary : public UncollidedSource
{
public:
  /// @param settings, light  must outlive this object
  UncollidedBoundary(const PropagationSettings& settings, const BoundaryLight& light);

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;

private:
  const PropagationSettings& Settings;
  const BoundaryLight& Light;
};
}
