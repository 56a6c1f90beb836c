#pragma once

#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"

#include "Device/Device.h"
#include "Device/Monitor.h"

namespace tyndall
{
/// The scheme as published: explicit steps of the radiance until it changes little (Gong et al., section 3). It does
/// not conserve energy; where it grows without end it is stopped, and says so.
/// @throws DeviceError, Aborted
OrdinatesResult SolvePublishedOrders(Device& device, const OrdinatesScene& scene, const OrdinatesAngles& angles,
  const OrdinatesSettings& settings, const Monitor& monitor);

/// Bytes on the device.
std::size_t BytesOfPublishedOrders(const Grid& grid, const OrdinatesAngles& angles, const OrdinatesSettings& settings);

/// Largest sigma_t of a channel times the step: from 1 on the scheme is not stable.
double ThickestStep(const Medium& medium, int channel);
}
