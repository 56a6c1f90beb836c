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
  int tries = 10;     ///< compare-and-swap attempts before a deposit is given up
  bool smooth = true; ///< apply the 3x3x3 Gaussian filter at the end
};

/// Losses from packing the light of a voxel into 64 bits.
struct PackingLoss
{
  Rgb deposited = {};       ///< W, sum of all deposits
  Rgb kept = {};            ///< W, sum of what the voxels hold
  std::size_t deposits = 0; ///< number of deposits in voxels
  std::size_t givenUp = 0;  ///< number of deposits given up after all tries

  double Relative() const; ///< fraction of the deposited power that was lost, channels summed
};

/// Photon marching as published by Pfeuti (2009, section 3.1.5), for comparison (numerics.md, section 12.4).
///
/// A voxel gains a photon's power, not power times path length, so the result is not an estimate of fluence. It is
/// converted to W / length^2 with the mean edge of a voxel, the cube root of its volume. `absorbed` is extinction times
/// that fluence, so that the energy balance shows the loss from packing. Results vary from run to run, because threads
/// add in any order.
///
/// Collective. A photon whose step enters a voxel of another block is sent there with its complete state, and makes the
/// same steps and deposits, bit for bit, for any partition. Only the order of deposits in a voxel differs, as it does
/// between runs: apart from the packing loss, light does not depend on the blocks. Each rank needs a halo of two voxels
/// of the index, and the octree levels of its own block only.
///
/// @param domain  the grid; `Domain(grid)` for a serial march
/// @param medium, ior, levels  of the rank's block, as for PhotonMarcher
/// @param share  this rank's photons: rank 0 has the first of all photons, then rank 1, and so on
/// @return arrays of the rank's block; `loss`, energy balance, face powers and counts of the whole grid
/// @throws InvalidInput as PhotonMarcher; DeviceError if the device has no 64-bit atomics
PhotonLight MarchPublished(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const std::uint8_t* levels, const std::vector<Photon>& share, const PublishedSettings& settings = {},
  PackingLoss* loss = nullptr, const Monitor& monitor = {}, RoundsTraffic* traffic = nullptr);
}
