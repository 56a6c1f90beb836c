#pragma once

#include "Lights/Lights.h"
#include "Medium/VoxelMeans.h"

#include <array>
#include <memory>
#include <vector>

class vtkVolumeProperty;

namespace tyndall
{
/// Transfer functions of a volume, and how a medium is made of them.
struct VolumeAppearance
{
  vtkVolumeProperty* property = nullptr;
  int vectorMode = -1, vectorComponent = 0; ///< as vtkParticipatingMedium has them
  bool colorIsEmission = false;             ///< whether the colour is emitted, instead of scattered
  Rgb g = {};                               ///< mean cosine of the phase function, per channel
  double factor = 1.0;                      ///< factor of all coefficients
  double shortestSpacing = 1.0;             ///< smallest edge of a voxel, length
};

/// Coefficients of a medium as functions of the scalars of a volume.
///
/// Values: scattering for each channel and then absorption for each channel, 1/length; or, if the colour is emitted,
/// absorption and then emission for each channel, W/(length^3 sr).
class VolumeCoefficients : public ScalarCoefficients
{
public:
  int ValueCount() const override { return (this->IsEmission ? 1 : this->Channels) + this->Channels; }

  int Channels = 1; ///< 1 if all colours of the scalars' ranges are grey, else 3
  bool IsEmission = false;
};

/// Smallest and largest finite value of a component of scalars.
using ScalarRange = std::array<double, 2>;

/// Tabulates the transfer functions over the ranges of the scalars' components. The number of ranges is the number of
/// components: 1, with independent components up to 4, otherwise 2 (colour by the first, opacity by the second) or 4
/// (colour in the first three, 0 to 255, opacity by the fourth).
/// @throws InvalidInput for another number of components, for transfer functions of two dimensions, gradient opacity or
///   a unit distance that is not positive
std::unique_ptr<VolumeCoefficients> CoefficientsOf(
  const VolumeAppearance& appearance, const std::vector<ScalarRange>& ranges);
}
