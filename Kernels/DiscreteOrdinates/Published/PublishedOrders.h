#pragma once

#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"

#include "Device/Device.h"
#include "Device/Monitor.h"

namespace tyndall
{
/// Solves one channel by the published scheme: explicit steps of the radiance until it changes little (Gong et al.,
/// section 3). It does not conserve energy.
/// @throws InvalidInput  as soon as the radiance grows without bound
/// @throws DeviceError, Aborted
OrdinatesResult SolvePublishedOrders(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles,
  const OrdinatesSettings& settings, const Monitor& monitor);

/// Bytes of device memory that SolvePublishedOrders() needs.
std::size_t BytesOfPublishedOrders(const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings);

/// Largest sigma_t of a channel times the length of a step; the scheme is unstable from 1 on.
double ThickestStep(const Medium& medium, int channel);
}
