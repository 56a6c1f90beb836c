#pragma once

#include "../Device/Buffer.h"
#include "../Device/Monitor.h"
#include "../Medium/Grid.h"
#include "TriangleMesh.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
struct VoxelizationSettings
{
  int samples = 4; ///< fine voxels an edge of a voxel, 1 to 16: occupancy comes in steps of 1 / samples^3

  /// Which way the columns run: along axis 0, 1 or 2, toggling what lies before a crossing or, from above, what lies after it.
  /// It makes no difference to the result, to the last bit.
  int columnAxis = 0;
  bool fromAbove = false;

  /// Bytes of the fine grid, a bit a sample, that are there at a time: a slab of voxels, of one layer at least.
  std::size_t slabBytes = std::size_t(16) << 20;
};

/// @throws InvalidInput
void Check(const VoxelizationSettings& settings);

/// Number of samples of each voxel that lie in each of several closed meshes. Where meshes overlap, the last of them has
/// the samples.
///
/// The bit-slice voxelisation of Eisemann and Decoret (Single-pass GPU solid voxelization for real-time applications,
/// Graphics Interface 2008; Pfeuti 2009, section 3.1.2): a column of samples is a row of bits, and every triangle toggles
/// those that lie before it. Samples are the centres of fine voxels. Points of the mesh are rounded to a lattice a
/// millionth of the box wide (SampleLattice), and from there on everything is exact: a column through an edge or a corner
/// is counted once, a closed mesh never leaks, and a sample is inside or not whichever way its column runs.
///
/// @param meshes  closed, or closed when rounded; see Examine. A triangle without area does nothing
/// @return        a buffer a mesh, x fastest: 0 to samples^3
/// @throws InvalidInput   where a setting or a mesh's size has no meaning
/// @throws DeviceError    if 2 bytes a voxel and mesh, the meshes and a slab do not fit the device
std::vector<Buffer<cl_ushort>> CountSamplesInside(Device& device, const Grid& grid,
  const std::vector<const TriangleMesh*>& meshes, const VoxelizationSettings& settings = {},
  const Monitor& monitor = {});

/// How often a mesh winds about the centres of voxels: 0 outside and 1 inside of a mesh that encloses everything once.
struct WindingNumbers
{
  int lowest = 0, highest = 0;
  std::size_t oddVoxels = 0;                      ///< voxels about which it winds neither 0 times nor once
  std::array<int, 3> firstOddVoxel = { 0, 0, 0 }; ///< of those the first in the order z, y, x
};

/// @param mesh  closed, corners counterclockwise seen from outside, or where `inverted` from inside
WindingNumbers FindWindings(
  Device& device, const Grid& grid, const TriangleMesh& mesh, bool inverted, const Monitor& monitor = {});
}
