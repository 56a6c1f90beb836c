#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "Distribution/Rounds.h"
#include "Medium/Medium.h"
#include "Photons/Photons.h"

#include <cstdint>
#include <vector>

namespace tyndall
{
struct PublishedSettings
{
  int tries = 10;     ///< of compare-and-swap before a deposit is given up
  bool smooth = true; ///< the 3x3x3 Gauss filter at the end
};

/// What packing the light of a voxel into 64 bits cost.
struct PackingLoss
{
  Rgb deposited = {};       ///< sum of all deposits, W
  Rgb kept = {};            ///< what is in the voxels, W
  std::size_t deposits = 0; ///< to voxels
  std::size_t givenUp = 0;  ///< of them, after all tries

  double Relative() const; ///< part of the power deposited that was lost, channels summed
};

/// Photon marching as Pfeuti publishes it (2009, section 3.1.5), to compare with (numerics.md, section 12.4).
///
/// A voxel gets a photon's power, not power times path, so its light is no estimate of fluence. It is given as W /
/// length^2 by the length that a voxel has on average, the cube root of its volume. `absorbed` is extinction times that
/// fluence, so that the balance shows what the packing loses. The result is not the same twice, since threads come in
/// any order.
///
/// Collective. A photon is handed on as it stands where the line of a step comes to another block's voxel, and makes
/// the same steps and deposits, bit for bit, whatever the blocks. Voxels get their deposits in another order, as they
/// do from call to call: light does not depend on the blocks but for what the packing loses. Each rank gets two voxels
/// of the index around its block, and of the octree the levels of its block.
///
/// @param domain  the grid; `Domain(grid)` for a serial march
/// @param medium, ior, levels  of the rank's block, as PhotonMarcher has them
/// @param share  some of the photons: all of them are those of rank 0, then those of rank 1, and so on
/// @return arrays of the rank's block; `loss`, balance, face powers and counts of the whole grid
/// @throws InvalidInput as PhotonMarcher; DeviceError where the device has no 64-bit atomics
PhotonLight MarchPublished(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const std::uint8_t* levels, const std::vector<Photon>& share, const PublishedSettings& settings = {},
  PackingLoss* loss = nullptr, const Monitor& monitor = {}, RoundsTraffic* traffic = nullptr);
}
