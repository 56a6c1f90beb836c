#pragma once

#include "DiscreteOrdinates/ChannelArrays.h"
#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"

namespace tyndall
{
/// The conservative scheme: orders of scattering one after the other, each a sweep along all directions and a
/// scattering into all (numerics.md, Eqs. (D7) to (D12)). The energy is kept to rounding.
/// @throws DeviceError, Aborted
OrdinatesResult SolveSweptOrders(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles,
  const OrdinatesSettings& settings, const Monitor& monitor);

/// Bytes on the device.
std::size_t BytesOfSweptOrders(const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings);
}
