#pragma once

#include "Device/Buffer.h"
#include "Light/LightField.h"
#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

namespace tyndall
{
/// Data from which a camera renders scattered light along any direction: LightField::scatteredMoments and straightOn,
/// in the solver's units and channels (numerics.md, section 14.7). All blocks of a medium store it in the same form.
class ShownLight
{
public:
  /// @param medium, scattering, basis, layout  must outlive this
  /// @param values  number of values of one angular moment in the largest block; degrees are kept as long as they fit
  ///   one gigabyte
  ShownLight(const Medium& medium, const TruncatedScattering& scattering, const AngularBasis& basis,
    const VolumeLayout& layout, std::size_t values);

  /// Whether the unscattered forward part (straightOn) differs between the channels of a voxel.
  bool HasColour() const { return this->Coloured; }
  void TakeColour(bool ofAll) { this->Coloured = ofAll; } ///< set if any block HasColour

  /// Adds the data to `light`.
  /// @param shown    IterationResult::shown
  /// @param scratch  of the same size, overwritten
  void AddTo(LightField& light, Device& device, const Buffer<float>& shown, const Buffer<float>& scratch) const;

private:
  std::vector<float> StraightOn() const;

  const Medium& TheMedium;
  const TruncatedScattering& Scattering;
  const AngularBasis& Basis;
  const VolumeLayout& Layout;
  int Harmonics;
  bool Coloured = false;
};
}
