#pragma once

#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Emission/EmissionPeaks.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// The uncollided flux of a small bright part of the medium, along exact rays (EmissionRays.h).
class UncollidedEmission : public UncollidedSource
{
public:
  /// @param error  as DepositEmission takes it
  UncollidedEmission(EmissionPeak peak, double error);

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;

private:
  SweepTally Put(const UncollidedVolume& volume, const Monitor& monitor) const;

  EmissionPeak Peak;
  double Error;
};

/// The uncollided flux of what empty voxels emit, swept along more directions and rays than scattered light. Nothing
/// there takes light, so that the length of every path shows, and few rays make those in the outermost voxels of what
/// emits too short (numerics.md, section 5.6).
class VacuumEmission : public UncollidedSource
{
public:
  /// Whether it is swept apart: not in grids so large that more rays would cost more than they gain, nor where
  /// emissionError is 0.
  static bool IsApart(const Grid& whole, const PropagationSettings& settings);
  /// Whether a voxel lets all of its own light through. @param sigma_t  1/length
  static bool IsEmpty(double sigma_t, const Grid& grid);
  static std::unique_ptr<const SweptDirections> DirectionsFor(const Grid& whole, const PropagationSettings& settings);

  /// @param along  must stay
  /// @param emission  of empty voxels, W / (length^3 sr), in the layout that Planar makes
  VacuumEmission(const SweptDirections& along, std::vector<float> emission);

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;

private:
  const SweptDirections& Along;
  std::vector<float> Emission;
};
}
