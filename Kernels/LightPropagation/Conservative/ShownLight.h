#pragma once

#include "Device/Buffer.h"
#include "Light/LightField.h"
#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

namespace tyndall
{
/// What a camera needs to show scattered light along any direction, LightField::scatteredMoments and straightOn, in the
/// solver's units and channels (numerics.md, section 14.7). Of blocks of one medium all have the same form.
class ShownLight
{
public:
  /// @param medium, scattering, basis, layout  must stay
  /// @param values  of one angular moment, of the largest block: of degrees so many are kept as fit a gigabyte
  ShownLight(const Medium& medium, const TruncatedScattering& scattering, const AngularBasis& basis,
    const VolumeLayout& layout, std::size_t values);

  /// What goes straight on differs between the channels of a voxel.
  bool HasColour() const { return this->Coloured; }
  void TakeColour(bool ofAll) { this->Coloured = ofAll; } ///< where that of another block has

  /// @param shown    IterationResult::shown
  /// @param scratch  as large, written over
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
