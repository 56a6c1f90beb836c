#pragma once

#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Emission/EmissionPeaks.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// Uncollided source: light of a localised emission along exact rays (EmissionRays.h). On several ranks each one traces
/// the rays of the whole domain and keeps the light of its block.
class UncollidedEmission : public UncollidedSource
{
public:
  /// @param error  accepted difference between the light of the first and the second half of a voxel's rays, relative
  ///   to the sum
  UncollidedEmission(EmissionPeak peak, double error);

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;

private:
  SweepTally Put(const UncollidedVolume& volume, const Monitor& monitor) const;
  SweepTally PutOnRanks(const UncollidedVolume& volume, const Monitor& monitor) const;

  EmissionPeak Peak;
  double Error;
};

/// Uncollided source: light emitted in empty (transparent) voxels, swept along more directions and rays than scattered
/// light. Since nothing attenuates this light, errors in path length are visible, and few rays make paths in the
/// outermost emitting voxels too short (numerics.md, section 5.6).
class VacuumEmission : public UncollidedSource
{
public:
  /// Whether emission from empty voxels is swept separately. False if emissionError is 0, and in grids so large that
  /// the additional rays would cost more time than their accuracy is worth.
  static bool IsApart(const Grid& whole, const PropagationSettings& settings);
  /// Whether a voxel counts as empty: the optical thickness along its longest edge is at most 1e-4.
  /// @param sigma_t  extinction, 1/length
  static bool IsEmpty(double sigma_t, const Grid& grid);
  static std::unique_ptr<const SweptDirections> DirectionsFor(const Grid& whole, const PropagationSettings& settings);

  /// @param along  must outlive this object
  /// @param emission  emission of the empty voxels, W / (length^3 sr), [channel][voxel] with the padding of
  ///   VolumeLayout
  VacuumEmission(const SweptDirections& along, std::vector<float> emission);

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;

private:
  const SweptDirections& Along;
  std::vector<float> Emission;
};
}
