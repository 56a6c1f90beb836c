#pragma once

#include "Device/ExactValues.h"
#include "LightPropagation/Sweep/Deposit.h"
#include "Lights/Lights.h"

#include <array>

namespace tyndall
{
/// From light that was found in a volume to what its voxels scatter of it: the source of the next sweep. Knows how the
/// medium scatters, and nothing of how light is carried. Each iteration uses the methods made for it: one order after
/// the other, or all orders at once between two sweeps. Arrays as in VolumeLayout.h.
class ScatteringOperator
{
public:
  virtual ~ScatteringOperator() = default;

  /// W, by channel.
  struct Powers
  {
    Rgb absorbed = {}, scattered = {};
  };

  /// One order of scattering: adds the light that a sweep found to `fluence`, writes what is scattered of it to
  /// `source`, and clears its path integrals.
  /// @param swept  path: of this order; flux gathers that of all orders, and is left as it is
  /// @param range  values of a channel that the sweep may have changed, whole vectors
  virtual Powers ScatterOrder(const Deposit& swept, const Buffer<float>& fluence, const Buffer<float>& source,
    const std::array<std::size_t, 2>& range) const = 0;

  /// Whether the next method can be used: the light of all orders holds what is needed.
  virtual bool CanScatterAllOrders() const = 0;

  /// The source of all orders at once from the fluence of all, less what the last one left over, which `source` holds
  /// (numerics.md, Eq. (44)).
  virtual void ScatterAllOrders(const Buffer<float>& fluence, const Buffer<float>& source) const = 0;

  /// Adds to `source` what is scattered of uncollided light. Path integrals may be negative: differences of light.
  virtual void AddFirstScattered(const Deposit& uncollided, const Buffer<float>& source) const = 0;

  /// Adds what is first scattered of a parallel beam, in voxels that scatter exactly in angle (BeamScattering.h), to
  /// one of the beams behind the angular moments of `source`.
  /// @param path  the beam's, W length, [channel][stride]
  virtual void AddBeam(const Buffer<float>& path, const Buffer<float>& source, int beam) const = 0;

  /// Writes one channel of `source`: what is given, and what is scattered of the fluence of all orders as it was found
  /// between two sweeps. Nowhere negative.
  /// @param swept  what the last sweep found: its angular distribution, for an operator that reads more than fluence
  /// @param fluence  of that channel, W / length^2
  /// @param given  emitted, and first scattered, W / (length^3 sr); negative where finer directions take light away
  virtual void ScatterFluence(int channel, const Deposit& swept, const ExactValues& fluence, const Buffer<float>& given,
    const Buffer<float>& source) const = 0;
};
}
