#pragma once

#include "LightPropagation/Scattering/IsotropicScattering.h"

#include <memory>

namespace tyndall
{
/// Scattering in angular moments (AngularBasis.h): of each moment of degree l its part of sigma_s goes on (numerics.md,
/// Eq. (42a)). Arrays are as MomentPlacesShared.h has them; the first moment is fluence, and scattered as
/// IsotropicScattering has it.
class MomentScattering : public ScatteringOperator
{
public:
  /// @param medium  must stay; it has scattering coefficients of degrees 0 to `degree`
  MomentScattering(Device& device, const VolumeLayout& layout, const MediumOnDevice& medium, int degree);

  Powers ScatterOrder(const Deposit& swept, const Buffer<float>& fluence, const Buffer<float>& source,
    const std::array<std::size_t, 2>& range) const override;
  bool CanScatterAllOrders() const override { return false; } ///< the moments of all orders are not kept
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

/// In moments of a degree, or where that is 0 alike into all directions.
/// @param scatters  as IsotropicScattering has it
std::unique_ptr<const ScatteringOperator> MakeScattering(
  Device& device, const VolumeLayout& layout, const MediumOnDevice& medium, int degree, bool scatters);

/// Adds the moments of one path to those of another, but for the first, which is the path itself.
void AddMoments(
  Device& device, const VolumeLayout& layout, int functions, const Buffer<float>& path, const Buffer<float>& to);

/// Takes all moments of a source to those that are shown: shown = source + part * shown.
/// @param values  that a source has in all
void AddToShown(
  Device& device, std::size_t values, const Buffer<float>& source, const Buffer<float>& shown, float part);

/// Adds the net flux that angular moments of a path hold to [channel][x, y, z][stride].
void AddFluxOfMoments(
  Device& device, const VolumeLayout& layout, int functions, const Buffer<float>& path, const Buffer<float>& flux);
}
