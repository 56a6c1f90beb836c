#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "Lights/Lights.h"
#include "PhaseFunction/PhaseFunction.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// First-collision source of a parallel beam along each direction of a quadrature, minus its truncated angular moments
/// in `basis`, in units of the mean of the scattered light over all directions (numerics.md, Eqs. (42b), (42c)).
/// The source is that of the phase function without its forward peak: a truncated series of moments with the peak would
/// be negative sideways. The peak is the part of the phase function above some level around the forward direction, with
/// as much power as delta-M treats as unscattered.
///
/// All moments of the result in `basis` are zero to rounding, so the moments of the scattered light do not change.
/// @param truncated  phase function as truncated by delta-M
/// @param beam  unit vector in which the beam travels
/// @return one value per direction of `set`
std::vector<double> BeyondMoments(const PhaseFunction& function, const DeltaM& truncated, const DirectionSet& set,
  const AngularBasis& basis, const std::array<double, 3>& beam);

/// Like BeyondMoments(), for moments that are smoothed so that the source is nowhere negative (WithoutNegatives,
/// numerics.md, section 2.3): the complete first-collision source of the beam minus its smoothed moments. The source
/// along each direction then follows the phase function, with the mean cosine of the smoothed moments; its higher
/// moments differ from the smoothed ones.
std::vector<double> BeyondSmoothMoments(const PhaseFunction& function, const DeltaM& truncated, const DirectionSet& set,
  const AngularBasis& basis, const std::array<double, 3>& beam);

/// First-collision sources of beams, stored in a source array after its angular moments. Each source is emitted in one
/// sweep: the one after the sweep during which its beam was traced.
class BeamsInSource
{
public:
  /// @param source  source array; must outlive this object
  /// @param first, count  index range of the beams in the source array
  BeamsInSource(Device& device, Buffer<float>& source, std::size_t first, std::size_t count)
    : TheDevice(device)
    , Source(source)
    , First(first)
    , Count(count)
  {
  }

  /// Moves the sources of the beams from the source array to a buffer of this object. Call before the sweep of the
  /// order during which the beams are traced.
  void Hold();
  /// Call after each sweep. Moves the sources of the beams back to the source array if Hold() has removed them;
  /// otherwise the sweep has emitted them, and they are set to 0.
  void GoOn();

private:
  Device& TheDevice;
  Buffer<float>& Source;
  std::size_t First, Count;
  Buffer<float> Held;
};

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
