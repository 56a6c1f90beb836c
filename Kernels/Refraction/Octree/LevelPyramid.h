#pragma once

#include "Refraction/Octree/MinMaxPyramid.h"

#include <vector>

namespace tyndall
{
/// Octree levels of a grid's voxels, found from the top of min-max pyramids down (Pfeuti 2009, section 3.1.3).
///
/// A voxel's level is the largest k for which its node, the cube of 2^k voxels per edge that begins at multiples of
/// 2^k, has max - min <= tolerance in every pyramid; 0, a single voxel, where there is none.
class LevelPyramid
{
public:
  /// @param grid  of more than one voxel
  /// @throws DeviceError if a byte per voxel and a byte per node of PyramidLayout do not fit the device
  LevelPyramid(Device& device, const Grid& grid);

  /// Keep nodes whole only where the range of one more quantity allows it, too. Queues the work and returns before it
  /// is done.
  /// @param tolerances  [level] of the quantity; must not grow with the level. [0] is not used
  void Restrict(const MinMaxPyramid& ranges, const std::vector<float>& tolerances);

  /// A level per voxel, x fastest; only after Restrict.
  const Buffer<cl_uchar>& Levels() const { return this->TheLevels; }

private:
  Device& TheDevice;
  PyramidLayout Layout;
  Buffer<cl_uchar> Nodes;
  Buffer<cl_uchar> TheLevels;
  bool Restricted = false;
};
}
