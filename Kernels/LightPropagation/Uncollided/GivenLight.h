#pragma once

#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Uncollided flux that another solver computed for each voxel (UncollidedImage.h, numerics.md, section 5.7).
///
/// The image is attenuated by the untruncated extinction of the medium, whereas sweeps treat the forward peak of
/// scattering as unscattered light. The light of the image that scatters into the forward peak is therefore a separate
/// source, AddStraightOn().
class GivenLight : public UncollidedSource
{
public:
  /// @param image, medium, scattering  in the units of power and length and the channels of the solve
  ///   (PropagationProblem); must outlive this object
  GivenLight(const UncollidedImage& image, const Medium& medium, const TruncatedScattering& scattering);

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;
  bool TalliesOwnVoxels() const override { return true; }

  /// Adds the light scattered into the forward peak to `source`, W / (length^3 sr), with its angular moments if `basis`
  /// is not null.
  /// @return whether any light scatters into the forward peak
  bool AddStraightOn(
    Device& device, const VolumeLayout& layout, const AngularBasis* basis, const Buffer<float>& source) const;

private:
  /// First moments (Deposit::firstMoments) of light that entered each voxel through the faces upstream of its mean
  /// direction, or, as far as it has none, through all faces alike (numerics.md, Eq. (41f)).
  /// @param path  path integrals, W length, [channel][voxel]
  std::vector<float> FirstMoments(const VolumeLayout& layout, const std::vector<float>& path) const;

  const UncollidedImage& Image;
  const Medium& TheMedium;
  const TruncatedScattering& Scattering;
};

/// Energy balance of the image's light: power that the medium removes and power that escapes, for `channels` channels
/// from `first` on, W. The faces through which the light entered are unknown: all of it is counted as incident on the
/// first face.
SweepTally TallyOf(const UncollidedImage& image, const Medium& medium, int first, int channels);

/// Value of the argument `peak` of AddNarrowMoments() that reduces the moments of a peak of light about one direction
/// just enough that it is nowhere negative: exp(-2 s) for the smallest s at which the peak with moments exp(-s l (l +
/// 1)), l up to `degree`, is nowhere negative.
double SmoothPeak(int degree);
}
