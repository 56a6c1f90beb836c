#pragma once

#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Angular/AngularValues.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "Lights/Lights.h"

#include <vector>

namespace tyndall
{
/// The angular moments in which light is scattered, along the directions of sweeps; beside them what is first scattered
/// of the brightest beams, each of which has a distribution of its own (BeamScattering.h).
class SweptMoments
{
public:
  /// @param phase  of the medium
  /// @param scattering  of a degree above 0
  /// @param lamps  that shine; of these the beams are the brightest that are directional, where all voxels and channels
  ///   scatter alike
  SweptMoments(const SweptDirections& directions, const PhaseOfMedium& phase, const TruncatedScattering& scattering,
    const std::vector<Light>& lamps);

  const AngularBasis& Basis() const { return this->TheBasis; }
  const AngularValues& Values() const { return this->OfDirections; } ///< for SweepRequest::angular
  int Beams() const { return static_cast<int>(this->LampOfBeam.size()); }
  int BeamOf(std::size_t lamp) const; ///< -1: it has none

private:
  AngularBasis TheBasis;
  AngularValues OfDirections;
  std::vector<int> LampOfBeam;
};
}
