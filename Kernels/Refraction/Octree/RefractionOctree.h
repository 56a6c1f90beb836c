#pragma once

#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "Medium/Medium.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tyndall
{
/// Conditions under which a node of the octree stays undivided.
struct OctreeSettings
{
  double tolerance = 0.01; ///< maximum difference of the refractive index in a node (Pfeuti's epsilon), in [0, 1]
  bool includeExtinction = false;   ///< whether the extinction must be nearly constant in a node as well
  bool leaveOut = true;             ///< whether to skip quantities that are constant, which restrict no node
  double extinctionTolerance = 0.1; ///< maximum difference of sigma_t within a node, times the node's diagonal; >= 0
};

/// Octree of voxels with nearly equal refractive index (Pfeuti 2009, section 3.1.3).
///
/// A node of level k is a cube of 2^k voxels per edge whose lowest voxel has indices that are multiples of 2^k. All its
/// voxels have level k. The conditions on a node of level k > 0 are
///  - max(n) - min(n) <= tolerance over the node's voxels;
///  - with includeExtinction, for every channel of sigma_t = sigma_a + sigma_s, (max(sigma_t) - min(sigma_t)) times the
///    node's diagonal <= extinctionTolerance. This bounds the error of the optical thickness of a straight path that is
///    computed with any sigma_t of the node.
/// No larger node would satisfy these conditions (numerics.md, Eq. (93); Pfeuti's listing has < for <=).
///
/// A grid whose size is not a power of two is treated as if its last voxel were repeated: nodes at its upper faces may
/// extend beyond it. The top level is the smallest k for which a node holds the entire grid. Ranges are compared in
/// float.
struct Octree
{
  std::vector<std::uint8_t>
    levels; ///< level of each voxel of the block, x fastest; 0: a single voxel, k: a node of 2^k voxels per edge
  int topLevel = 0;                 ///< highest possible level, ceil(log2(longest edge in voxels))
  std::string device;               ///< name of the device that was used; empty if none was needed
  std::vector<std::string> leftOut; ///< which parts of the computation were skipped and why, for the user
};

/// Builds the octree. Collective. Each rank builds three levels in its block. The higher levels have a 512th of the
/// grid's voxels and are built on every rank from the ranges of all blocks (numerics.md, section 11.5). The levels do
/// not depend on the partition.
/// @param domain  the grid and its partition; `Domain(grid)` for a serial build
/// @param medium  medium in this rank's block, on the grid domain.OwnGrid(); its coefficients are used if extinction is
///   included
/// @param index   refractive index n in this rank's block, one component; finite and above 0
/// @param device  part of the device's name, as for Device::Find; no device is opened if n and extinction are constant,
///   as the octree is then a single node
/// @throws InvalidInput if a setting, the grid, n (names the first such voxel) or a coefficient is invalid
/// @throws DeviceError if there is no such device, or its memory is not sufficient: about 7 bytes per voxel of a large
///   cube
Octree BuildOctree(const Domain& domain, const Medium& medium, const Field& index, const OctreeSettings& settings,
  const std::string& device = {}, const Monitor& monitor = {});
}
