#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"

#include <algorithm>

namespace tyndall
{
/// Thrown out of a computation that took longer than it was given.
struct TimeIsUp
{
};

/// Progress of the part [from, to] of the work; throws TimeIsUp when the device's clock is past `end`.
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

/// What work takes on two slow cores, seconds. What the reference is made of is decided by these and never by a clock,
/// so that it is the same however busy the machine is; a clock only stops what takes too long all the same.
struct NominalSeconds
{
  static constexpr double OfRayVoxel = 5e-9;   ///< a sweep along one ray through one voxel, of one channel
  static constexpr double OfPhoton = 3e-6;     ///< besides its way
  static constexpr double OfCrossing = 1e-7;   ///< of a voxel, by a photon
  static constexpr double OfScattering = 1e-6; ///< of a photon
};
}
