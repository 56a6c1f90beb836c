#pragma once

#include "LightPropagation/Scattering/IsotropicScattering.h"

#include <memory>

namespace tyndall
{
/// Anisotropic scattering in angular moments (AngularBasis.h): each moment of degree l is multiplied by the scattering
/// coefficient of that degree (numerics.md, Eq. (42a)). Array layout: MomentPlacesShared.h. The first moment is the
/// fluence and is scattered by IsotropicScattering.
class MomentScattering : public ScatteringOperator
{
public:
  /// @param medium  scattering coefficients of degrees 0 to `degree`; must outlive this object
  MomentScattering(Device& device, const VolumeLayout& layout, const MediumOnDevice& medium, int degree);

  Powers ScatterOrder(const Deposit& swept, const Buffer<float>& fluence, const Buffer<float>& source,
    const std::array<std::size_t, 2>& range) const override;
  bool CanScatterAllOrders() const override { return false; } ///< no: moments of all orders are not stored
  void ScatterAllOrders(const Buffer<float>& fluence, const Buffer<float>& source) const override;
  void AddFirstScattered(const Deposit& uncollided, const Buffer<float>& source) const override;
  void AddBeam(const Buffer<float>& path, const Buffer<float>& source, int beam) const override;
  void ScatterFluence(int channel, const Deposit& swept, const ExactValues& fluence, const Buffer<float>& given,
    const Buffer<float>& source) const override;

private:
  template <class... Arguments>
  void RunOnMoments(const char* name, int channel, const Arguments&... arguments) const;
  float PerPath() const;

  Device& TheDevice;
  VolumeLayout Layout;
  const MediumOnDevice& TheMedium;
  IsotropicScattering OfFluence;
  int Degree;
  int Functions;
};

/// Makes a MomentScattering if `degree` is above 0, else an IsotropicScattering.
/// @param scatters  whether sigma_s is above zero anywhere; used by IsotropicScattering only
std::unique_ptr<const ScatteringOperator> MakeScattering(
  Device& device, const VolumeLayout& layout, const MediumOnDevice& medium, int degree, bool scatters);

/// Adds the angular moments of `path` to those of `to`, W length, except the first moment, which is the path integral
/// itself.
/// @param functions  number of functions of the angular basis
void AddMoments(
  Device& device, const VolumeLayout& layout, int functions, const Buffer<float>& path, const Buffer<float>& to);

/// Computes shown = source + part * shown, for all angular moments of a source; `shown` are the moments that are stored
/// for pictures (IterationResult::shown).
/// @param values  number of values in each array
void AddToShown(
  Device& device, std::size_t values, const Buffer<float>& source, const Buffer<float>& shown, float part);

/// Adds to `flux` the net flux, W length, [channel][x, y, z][voxel], from the angular moments of degree 1 of `path`.
void AddFluxOfMoments(
  Device& device, const VolumeLayout& layout, int functions, const Buffer<float>& path, const Buffer<float>& flux);
}
