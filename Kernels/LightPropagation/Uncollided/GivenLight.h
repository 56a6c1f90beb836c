#pragma once

#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Uncollided flux that another solver computed for each voxel (UncollidedImage.h, numerics.md, section 5.7).
///
/// The other solver attenuates the light by the full extinction of the medium. Sweeps use a truncated extinction: they
/// treat light that is scattered into the forward peak of the phase function as unscattered. Such light is therefore
/// added as a separate source, by AddStraightOn().
class GivenLight : public UncollidedSource
{
public:
  /// @param image, medium, scattering  with the channels and the units of power and length of the solve
  ///   (PropagationProblem); must outlive this object
  GivenLight(const UncollidedImage& image, const Medium& medium, const TruncatedScattering& scattering);

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;
  bool TalliesOwnVoxels() const override { return true; }

  /// Adds the light that is scattered into the forward peak of the phase function to `source`, W / (length^3 sr), with
  /// angular moments if `basis` is not null.
  /// @return whether any light scatters into the forward peak
  bool AddStraightOn(
    Device& device, const VolumeLayout& layout, const AngularBasis* basis, const Buffer<float>& source) const;

private:
  /// First moments (Deposit::firstMoments) of the light (numerics.md, Eq. (41f)). In each voxel, a fraction of the
  /// light equal to the length of the mean direction is taken to enter through the faces upstream of that direction,
  /// the remainder through all faces, both in proportion to the light that comes to the faces. Collective.
  /// @param path  path integrals, W length, [channel][voxel]
  std::vector<float> FirstMoments(const UncollidedVolume& volume, const std::vector<float>& path) const;

  const UncollidedImage& Image;
  const Medium& TheMedium;
  const TruncatedScattering& Scattering;
};

/// Energy balance of the image's light: power that the medium removes, and power that escapes, W, for `channels`
/// channels from channel `first` on. The faces through which the light entered are unknown, so all light is counted as
/// incident on face 0 (-x).
SweepTally TallyOf(const UncollidedImage& image, const Medium& medium, int first, int channels);

/// Value for the argument `peak` of AddNarrowMoments(). It reduces the moments of light along one direction just enough
/// that the truncated series is nowhere negative. The value is exp(-2 s) for the smallest s at which the series with
/// moments exp(-s l (l + 1)), l up to `degree`, is nowhere negative.
double SmoothPeak(int degree);
}
