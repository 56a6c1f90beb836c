#pragma once

#include "Device/ExactValues.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "Lights/Lights.h"

#include <array>

namespace tyndall
{
/// Computes the scattering source of the next sweep from the light in the volume. Knows how the medium scatters, and
/// nothing about transport. ScatterOrder and ScatterAllOrders serve source iteration, ScatterFluence serves DSA. Array
/// layout: VolumeLayout.h.
class ScatteringOperator
{
public:
  virtual ~ScatteringOperator() = default;

  /// Powers by channel, W.
  struct Powers
  {
    Rgb absorbed = {}, scattered = {};
  };

  /// One scattering order: adds the light of a sweep to `fluence`, writes its scattering source to `source`, and clears
  /// its path integrals.
  /// @param swept  path: of this order; flux: sum over all orders, not changed
  /// @param range  index range of a channel that the sweep may have changed, in whole vectors
  virtual Powers ScatterOrder(const Deposit& swept, const Buffer<float>& fluence, const Buffer<float>& source,
    const std::array<std::size_t, 2>& range) const = 0;

  /// Whether ScatterAllOrders can be used: the fluence of all orders suffices to compute their source.
  virtual bool CanScatterAllOrders() const = 0;

  /// Computes the source of all orders from their fluence, minus the source that the last order left unswept, which
  /// `source` holds on entry (numerics.md, Eq. (44)).
  virtual void ScatterAllOrders(const Buffer<float>& fluence, const Buffer<float>& source) const = 0;

  /// Adds the first-collision source of uncollided light to `source`. Path integrals may be negative, as differences of
  /// light.
  virtual void AddFirstScattered(const Deposit& uncollided, const Buffer<float>& source) const = 0;

  /// Adds the first-collision source of a parallel beam to the part of `source` that belongs to this beam, which
  /// follows the angular moments. Only in voxels whose first scattering is exact in angle (BeamScattering.h).
  /// @param path  path integrals of the beam, W length, [channel][stride]
  virtual void AddBeam(const Buffer<float>& path, const Buffer<float>& source, int beam) const = 0;

  /// Writes one channel of `source`: the given source plus the scattering source of a fluence that contains all orders,
  /// as computed between two sweeps. Nowhere negative.
  /// @param swept  light of the last sweep, for operators that also need its angular distribution
  /// @param fluence  of that channel, W / length^2
  /// @param given  emission and first-collision source, W / (length^3 sr); negative where the finer quadrature removes
  ///   light
  virtual void ScatterFluence(int channel, const Deposit& swept, const ExactValues& fluence, const Buffer<float>& given,
    const Buffer<float>& source) const = 0;
};
}
