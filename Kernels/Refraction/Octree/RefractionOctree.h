#pragma once

#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "Medium/Medium.h"

#include <cstdint>
#include <string>
#include <vector>

namespace tyndall
{
/// When a node of the octree is kept whole.
struct OctreeSettings
{
  double tolerance = 0.01;          ///< Pfeuti's epsilon: largest difference of the refractive index, in [0, 1]
  bool includeExtinction = false;   ///< whether extinction has to be even, too
  double extinctionTolerance = 0.1; ///< largest difference of optical thickness, >= 0; see Octree
};

/// Groups of voxels of nearly equal refractive index (Pfeuti 2009, section 3.1.3).
///
/// What a level k promises: the voxel lies in a node, the cube of 2^k voxels per edge whose lowest voxel has indices
/// that are multiples of 2^k, and all voxels of that node have level k and
///  - max(n) - min(n) <= tolerance over the node's voxels, where k > 0;
///  - with includeExtinction, for every channel of sigma_t = sigma_a + sigma_s,
///    (max(sigma_t) - min(sigma_t)) times the node's diagonal <= extinctionTolerance, where k > 0: whichever of the
///    node's sigma_t is taken for a straight way through it, the way's optical thickness is off by no more.
/// No larger node would keep the promise (numerics.md, Eq. (93); the paper's listing has < for <=).
///
/// A grid whose size is not a power of two is treated as if its last voxel were repeated: nodes at its upper faces may
/// stick out of it, up to the top level, the smallest k whose node holds the whole grid. Ranges are compared in float.
struct Octree
{
  std::vector<std::uint8_t>
    levels;             ///< one per voxel of the block, x fastest; 0: a single voxel, k: a node of 2^k voxels per edge
  int topLevel = 0;     ///< ceil(log2(longest edge in voxels))
  double seconds = 0.0; ///< of BuildOctree
  std::string device;   ///< that ran; empty: none had to
  std::vector<std::string> leftOut; ///< what the scene did not need
};

/// Collective. Each rank makes three levels of its own block; those above, a 512th of the grid, are made on every rank
/// from the ranges of all (numerics.md, section 11.4). The levels do not depend on the blocks.
/// @param domain  the grid; `Domain(grid)` for a serial build
/// @param medium  of the rank's block, its grid domain.OwnGrid(); where extinction is included its coefficients
/// @param index   of the rank's block: refractive index n, one component; finite and above 0
/// @param device  part of the device's name as Device::Find takes it; looked for only where there is something to
///   compute: where everything is constant, the octree is one node and nothing runs on the device
/// @throws InvalidInput where a setting, the grid, n (names the first such voxel) or a coefficient has no meaning
/// @throws DeviceError if there is no such device, or its memory does not suffice: about 7 bytes per voxel of a large
/// cube
Octree BuildOctree(const Domain& domain, const Medium& medium, const Field& index, const OctreeSettings& settings,
  const std::string& device = {}, const Monitor& monitor = {});
}
