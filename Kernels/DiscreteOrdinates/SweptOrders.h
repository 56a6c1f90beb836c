#pragma once

#include "DiscreteOrdinates/ChannelArrays.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"

namespace tyndall
{
/// Conservative scheme: source iteration; each order is a sweep along all directions followed by scattering between
/// them (numerics.md, Eqs. (D7) to (D12)). Energy is conserved to rounding.
/// @throws DeviceError, Aborted
OrdinatesResult SolveSweptOrders(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles,
  const OrdinatesSettings& settings, const Monitor& monitor);

/// Whether a solve can use a first guess: only if no source can be negative. Negative sources that N terms produce are
/// set to 0 order by order, so the light is not linear in its orders, which a guess requires.
bool CanBeginWarm(const OrdinatesAngles& angles, const OrdinatesSettings& settings);

/// Bytes of device memory needed.
std::size_t BytesOfSweptOrders(const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings);
}
