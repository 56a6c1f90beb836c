#pragma once

#include "DiscreteOrdinates/ChannelArrays.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"

namespace tyndall
{
/// Solves one channel by the conservative scheme: source iteration, in which each order is a sweep along all directions
/// followed by scattering between them (numerics.md, Eqs. (D7) to (D12)). Energy is conserved to rounding.
/// @throws DeviceError, Aborted
OrdinatesResult SolveSweptOrders(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles,
  const OrdinatesSettings& settings, const Monitor& monitor);

/// Bytes of device memory that SolveSweptOrders() needs.
std::size_t BytesOfSweptOrders(const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings);
}
