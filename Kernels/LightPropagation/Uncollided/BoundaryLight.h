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
/// Incident radiance on the box's faces along a set of directions (numerics.md, Eq. (31)): the sum of the emission of
/// the faces, the sky and the environment. The peaks of the environment are excluded; they are treated as lamps
/// (EnvironmentPeaks.h).
class BoundaryLight
{
public:
  /// @param directions  the quadrature; must outlive this object
  /// @param farAway  the illumination's environment without its peaks
  BoundaryLight(const Grid& grid, const PropagationSettings& settings, const SweptDirections& directions,
    const Illumination& illumination, const Environment& farAway);

  bool Shines() const { return this->AnyLight; }
  /// The incident radiance is the same for all directions and all non-periodic faces.
  bool IsEven() const { return this->AllAlike; }
  bool IsLit(int direction) const; ///< whether the direction has incident radiance on a non-periodic face
  /// Incident radiance through `face`, W / (length^2 sr), averaged over the directions that this one represents.
  Rgb Incoming(int direction, int face) const;
  SweepBoundary Boundary() const; ///< Incoming() as a function for a sweep; this object must outlive it
  /// Incident power per area through each of the box's faces, W / length^2; 0 where the axis is periodic.
  std::array<Rgb, 6> IncomingPower() const;

  /// Checks that whole rays carry enough of the incident power. Through the faces parallel to their marching axis few
  /// rays enter if the box has few planes of voxels across that axis.
  /// @param channels  number of channels to check
  /// @throws InvalidInput if whole rays would miss more than 30% of the power that enters through the emitting faces
  void CheckRays(int channels) const;
  /// Whether CheckRays() would pass whichever of the non-periodic faces emits.
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
  /// Sky and environment: by direction, averaged over the directions that it represents.
  std::vector<Rgb> FromFarAway;
  bool AnyLight = false;
  bool AllAlike = true;
};

/// Sweeps once along a quadrature of its own, in batches whose rays fit into memory. Collective if the grid is divided
/// into blocks.
/// @param isLit  whether a direction carries any light
/// @param source  as for SweepOperator, with the moments of the volume's basis; null: no emission
/// @param incoming  boundary source; may be empty
SweepTally SweepAlong(const UncollidedVolume& volume, const SweptDirections& along,
  const std::function<bool(int)>& isLit, const Buffer<float>* source, const SweepBoundary& incoming,
  const Monitor& monitor);

/// The uncollided flux of emitting faces, sky and environment, from one sweep along a quadrature of its own. Shadow
/// edges need many directions; scattered light, which is swept every order, is smooth and needs few.
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
