#pragma once

#include "Photons/Marching/MarchMedium.h"

#include <functional>
#include <vector>

namespace tyndall
{
/// What PhotonMarcher::Paths does.
std::vector<PhotonPath> TracePaths(
  const MarchMedium& medium, const std::vector<Photon>& photons, const std::vector<std::size_t>& chosen);

/// Corners of ways: place in voxels, power that is left there.
using CornersOfWays = std::vector<std::vector<cl_float4>>;

/// Those that a kernel with PATHS finds of each way.
/// @param ways   a work-item each
/// @param queue  queues it, twice: first it only counts corners
CornersOfWays TraceCorners(const MarchMedium& medium, std::size_t ways,
  const std::function<void(bool counting, const Buffer<cl_int>& offsets, const Buffer<cl_float4>& corners,
    const Buffer<cl_int>& counts)>& queue);

/// Options of such a kernel.
std::string PathOptions();

/// A packed photon's path.
PhotonPath PathOf(const Grid& grid, const PackedPhotons& packed, std::size_t i, const std::vector<cl_float4>& corners);
}
