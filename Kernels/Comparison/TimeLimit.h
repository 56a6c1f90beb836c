#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"

#include <algorithm>

namespace tyndall
{
/// Thrown out of a computation that exceeds its time limit.
struct TimeIsUp
{
};

/// Monitor for the part [from, to] of the work; throws TimeIsUp once the device's clock is past `end`.
inline Monitor PartUntil(const Device& device, double end, const Monitor& monitor, double from, double to)
{
  return [=, &device](double done) {
    if (device.Now() > end)
    {
      throw TimeIsUp();
    }
    return !monitor || monitor(from + (to - from) * std::clamp(done, 0.0, 1.0));
  };
}

/// Nominal run times on two slow cores, seconds. They, not a clock, determine how the reference is computed, so that it
/// does not depend on the machine's load; a clock only stops work that takes too long nevertheless.
struct NominalSeconds
{
  static constexpr double OfRayVoxel = 5e-9;   ///< sweep of one ray through one voxel, one channel
  static constexpr double OfPhoton = 3e-6;     ///< per photon, without its path
  static constexpr double OfCrossing = 1e-7;   ///< per voxel crossed by a photon
  static constexpr double OfScattering = 1e-6; ///< per scattering of a photon
};
}
