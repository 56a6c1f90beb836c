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

/// Whether a solve can begin from the light of another: sources are never negative. Sources that N terms make negative
/// are set to 0 order by order, so that the light is not linear in its orders, as a guess needs it to be.
bool CanBeginWarm(const OrdinatesAngles& angles, const OrdinatesSettings& settings);

/// Bytes on the device.
std::size_t BytesOfSweptOrders(const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings);
}
