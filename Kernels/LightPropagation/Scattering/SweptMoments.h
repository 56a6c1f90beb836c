#pragma once

#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "Lights/Lights.h"

#include <vector>

namespace tyndall
{
/// Angular basis of scattered light with its values in the directions of sweeps, and the separate angular distributions
/// of first-scattered light of the brightest beams (BeamScattering.h).
class SweptMoments
{
public:
  /// @param phase  phase function of the medium
  /// @param scattering  truncation of the phase function, of a degree above 0
  /// @param lamps  lamps of the scene; the (at most four) brightest directional ones become beams, if the phase
  ///   function is the same in all voxels and channels
  SweptMoments(const SweptDirections& directions, const PhaseOfMedium& phase, const TruncatedScattering& scattering,
    const std::vector<Light>& lamps);

  const AngularBasis& Basis() const { return this->TheBasis; }
  const AngularValues& Values() const { return this->OfDirections; } ///< pass as SweepRequest::angular
  int Beams() const { return static_cast<int>(this->LampOfBeam.size()); }
  int BeamOf(std::size_t lamp) const; ///< index of a lamp's beam; -1: none

private:
  AngularBasis TheBasis;
  AngularValues OfDirections;
  std::vector<int> LampOfBeam;
};
}
