#pragma once

#include "Device/Device.h"
#include "Device/ExactValues.h"
#include "LightPropagation/Problem/TruncatedScattering.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Lights/Lights.h"

#include <array>
#include <memory>

namespace tyndall
{
/// Computes the scattering source of the next sweep from the light in the volume. ScatterOrder and ScatterAllOrders
/// serve source iteration, ScatterFluence serves diffusion synthetic acceleration. Array layout: VolumeLayout.h.
class ScatteringOperator
{
public:
  virtual ~ScatteringOperator() = default;

  /// Power that voxels absorb and scatter, W, by channel.
  struct Powers
  {
    Rgb absorbed = {}, scattered = {};
  };

  /// Processes one scattering order: adds the light of a sweep to `fluence`, writes its scattering source to `source`,
  /// and sets the path integrals of the sweep to 0.
  /// @param swept  light of the sweep; its flux is a sum over all orders and is not cleared
  /// @param fluence  fluence of all orders, W / length^2; added to
  /// @param source  scattering source, W / (length^3 sr); overwritten
  /// @param range  index range of each channel outside which the path integrals are 0, in whole vectors
  /// @return absorbed and scattered power of this order
  virtual Powers ScatterOrder(const Deposit& swept, const Buffer<float>& fluence, const Buffer<float>& source,
    const std::array<std::size_t, 2>& range) const = 0;

  /// Whether ScatterAllOrders can be used, i.e. the fluence of all orders suffices to compute their source.
  virtual bool CanScatterAllOrders() const = 0;

  /// Computes the scattering source of all orders from the fluence of all orders, minus the source of the last order,
  /// which has not been swept and is in `source` on entry (numerics.md, Eq. (44)).
  virtual void ScatterAllOrders(const Buffer<float>& fluence, const Buffer<float>& source) const = 0;

  /// Adds the first-collision source of uncollided light to `source`. Path integrals may be negative if they are
  /// differences of two solutions.
  virtual void AddFirstScattered(const Deposit& uncollided, const Buffer<float>& source) const = 0;

  /// Adds the first-collision source of a parallel beam to its range of `source`, after the angular moments, in voxels
  /// whose first-scattered light follows the phase function instead of truncated moments (BeamScattering.h).
  /// @param path  path integrals of the beam, W length, [channel][voxel]
  /// @param beam  index of the beam, see SweptMoments::BeamOf()
  virtual void AddBeam(const Buffer<float>& path, const Buffer<float>& source, int beam) const = 0;

  /// Writes one channel of `source`: the given source (emission and first collisions) plus the scattering source of the
  /// fluence of all orders, as DSA computes it between two sweeps. Nowhere negative.
  /// @param swept  light of the last sweep, for operators that also need its angular distribution
  /// @param fluence  fluence of this channel, W / length^2
  /// @param given  emission and first-collision source, W / (length^3 sr); negative where a correction by a finer
  ///   quadrature removes light
  virtual void ScatterFluence(int channel, const Deposit& swept, const ExactValues& fluence, const Buffer<float>& given,
    const Buffer<float>& source) const = 0;
};

/// Makes the operator of isotropic scattering if `degree` is 0, else that of scattering in angular moments.
/// @param medium  scattering coefficients of degrees 0 to `degree`; must outlive the operator
/// @param scatters  false, for degree 0: sigma_s is zero everywhere, and no source is written
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
