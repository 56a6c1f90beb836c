#pragma once

#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Uncollided light that another solver found by voxel (UncollidedImage.h, numerics.md, section 5.7).
///
/// The image is of light as the medium extinguishes it, while sweeps take the forward peak of what is scattered as
/// light that goes straight on: what of the image's light goes on so is a source of its own.
class GivenLight : public UncollidedSource
{
public:
  /// @param image, medium, scattering  must stay; in the solver's units and channels
  GivenLight(const UncollidedImage& image, const Medium& medium, const TruncatedScattering& scattering);

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;
  bool TalliesOwnVoxels() const override { return true; }

  /// Adds what goes straight on to a source, with its angular moments where there is a basis.
  /// @return whether anything does
  bool AddStraightOn(
    Device& device, const VolumeLayout& layout, const AngularBasis* basis, const Buffer<float>& source) const;

private:
  const UncollidedImage& Image;
  const Medium& TheMedium;
  const TruncatedScattering& Scattering;
};

/// What of an image's light the medium takes and what leaves, of some channels; all is counted as coming in through the
/// first face, which is not known.
SweepTally TallyOf(const UncollidedImage& image, const Medium& medium, int first, int channels);

/// exp(-2 s) with the least s for which a peak whose moments up to a degree fall as exp(-s l (l + 1)) is nowhere
/// negative: what AddNarrowMoments takes.
double SmoothPeak(int degree);
}
