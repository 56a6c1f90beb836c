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
/// Light that leaves through the cells of the box's faces on the device, and what comes back of it.
class FaceLight : public FaceReflection
{
public:
  /// @param powerIn  W that radiance 1 brings through each cell along the directions of sweeps
  FaceLight(
    Device& device, const Grid& grid, int channels, std::vector<double> powerIn, const std::array<Rgb, 6>& albedo);

  const Buffer<float>& Out() const { return this->Leaving; } ///< for Deposit::faceOut
  const Buffer<float>& In() const { return this->Entering; } ///< for SweepRequest::faceIn

  /// What left since the last call came along rays that are not those of sweeps.
  void TakeUncollided() { this->Uncollided = this->TakeOut(); }
  /// What left since the last call, and the uncollided light before it: lets the part come in that is reflected.
  /// @return W that come back through each face
  std::array<Rgb, 6> Reflect();
  /// Of what the last call of Reflect let in, which may be negative (WarmStart), the magnitudes by cell added up; W.
  const Rgb& Magnitude() const { return this->LastMagnitude; }
  /// W that left through each cell since the last call of anything here, [channel][cell].
  std::vector<float> TakeOut();
  /// Lets W come in through each cell, [channel][cell].
  void LetIn(const std::vector<double>& swept, const std::vector<double>& uncollided);

  /// W that left through each cell in all calls of Reflect, [channel][cell]. Of what sweeps took out the pattern of
  /// their rays is taken away; the sums over faces are as they were.
  std::vector<double> LeftInAll() const;

private:
  std::vector<float> Uncollided;
  std::vector<double> AllSwept, AllUncollided;
  Rgb LastMagnitude = {};
  Buffer<float> Leaving, Entering; ///< [channel][cell]
};

/// W that radiance 1 brings through each cell of the box's faces along the rays of sweeps, which come in through some
/// planes of voxels more than through others.
/// @param spreads  each through all cells that it stands for (Deposit::spreadsAside)
std::vector<double> SweptPowerIn(
  const Grid& grid, const std::array<bool, 3>& periodic, const SweptDirections& directions, bool spreads);
}
