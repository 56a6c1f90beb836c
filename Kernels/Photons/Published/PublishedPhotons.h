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
  bool smooth = true; ///< whether the 3x3x3 Gaussian filter is applied to the light
};

/// Power that is lost because the light of a voxel is packed into 64 bits.
struct PackingLoss
{
  Rgb deposited = {};       ///< W, sum of all deposits, including what packing loses
  Rgb kept = {};            ///< W, the part of `deposited` that the packed light of the voxels still contains
  std::size_t deposits = 0; ///< number of deposits in voxels
  std::size_t givenUp = 0;  ///< number of deposits that were lost because all compare-and-swap attempts failed

  double Relative() const; ///< power lost relative to power deposited, both summed over the channels
};

/// Photon marching as published by Pfeuti (2009, section 3.1.5), for comparison (numerics.md, section 12.4).
///
/// A voxel gains a photon's power, not power times path length, so the result is not an estimate of fluence. It is
/// converted to W / length^2 with the mean edge of a voxel, the cube root of its volume. In the energy balance,
/// `absorbed` is extinction times that fluence, so that the balance shows the loss by packing. Results vary from run
/// to run, because threads add deposits in any order.
///
/// Collective. A photon whose step enters a voxel of another rank's block is sent there with its complete state, and
/// has the same steps and deposits, bit for bit, for any partition. The order of deposits in a voxel may differ, as
/// it does between runs: apart from the loss by packing, light does not depend on the partition. Each rank needs the
/// index in a halo of two voxels, and the octree levels of its own block only.
///
/// @param domain  the grid and its partition; `Domain(grid)` for a serial march
/// @param medium, ior, levels  medium, refractive index and octree levels of this rank's block, as for PhotonMarcher
/// @param share  this rank's photons: all photons are those of rank 0, then those of rank 1, and so on
/// @return arrays of this rank's block; `loss`, energy balance, face powers and counts of the domain
/// @throws InvalidInput as PhotonMarcher; DeviceError if the device has no 64-bit atomics
PhotonLight MarchPublished(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const std::uint8_t* levels, const std::vector<Photon>& share, const PublishedSettings& settings = {},
  PackingLoss* loss = nullptr, const Monitor& monitor = {}, RoundsTraffic* traffic = nullptr);
}
