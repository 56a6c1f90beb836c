#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Angular/SweptDirections.h"
#include "LightPropagation/FaceReflection.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Outgoing power and reflected radiance by cell of the box faces, on the device.
class FaceLight : public FaceReflection
{
public:
  /// @param powerIn  by cell: W that radiance 1 carries into the box along the directions of sweeps
  FaceLight(
    Device& device, const Grid& grid, int channels, std::vector<double> powerIn, const std::array<Rgb, 6>& albedo);

  const Buffer<float>& Out() const { return this->Leaving; } ///< for Deposit::faceOut
  const Buffer<float>& In() const { return this->Entering; } ///< for SweepRequest::faceIn

  /// Takes the power that left since the last call as uncollided light, which did not leave along the rays of sweeps.
  void TakeUncollided() { this->Uncollided = this->TakeOut(); }
  /// Reflects the power that left since the last call, together with the uncollided light taken before: In() becomes
  /// the reflected radiance.
  /// @return reflected power by face, W
  std::array<Rgb, 6> Reflect();
  /// Sum over cells of the magnitude of the power that the last Reflect() let in, W. Power by cell may be negative
  /// after a warm start.
  const Rgb& Magnitude() const { return this->LastMagnitude; }
  /// Power that left through each cell since the last call of any method here, W, [channel][cell].
  std::vector<float> TakeOut();
  /// Sets In() such that these powers enter through each cell, W, [channel][cell].
  void LetIn(const std::vector<double>& swept, const std::vector<double>& uncollided);

  /// Power that left through each cell, summed over all calls of Reflect, W, [channel][cell]. The uneven pattern of the
  /// rays is removed from the swept part; sums over faces are unchanged.
  std::vector<double> LeftInAll() const;

private:
  std::vector<float> Uncollided;
  std::vector<double> AllSwept, AllUncollided;
  Rgb LastMagnitude = {};
  Buffer<float> Leaving, Entering; ///< [channel][cell]
};

/// By cell: W that radiance 1 carries into the box along the rays of sweeps. The rays cross some planes of voxels more
/// often than others.
/// @param spreads  each ray spreads its power over all cells that it represents (Deposit::spreadsAside)
std::vector<double> SweptPowerIn(
  const Grid& grid, const std::array<bool, 3>& periodic, const SweptDirections& directions, bool spreads);
}
