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

/// Whether light can begin from that of another solve: sources are never negative. What N terms make negative is set to
/// 0 order by order, so that the light is not the sum that a guess would need it to be.
bool CanBeginWarm(const OrdinatesAngles& angles, const OrdinatesSettings& settings);

/// Bytes on the device.
std::size_t BytesOfSweptOrders(const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings);
}
