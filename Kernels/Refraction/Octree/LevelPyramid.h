#pragma once

#include "Refraction/Octree/MinMaxPyramid.h"

#include <vector>

namespace tyndall
{
/// Octree levels of a grid's voxels, found from the top of min-max pyramids down (Pfeuti 2009, section 3.1.3).
///
/// A voxel's level is the largest k for which its node, the cube of 2^k voxels an edge that begins at multiples of 2^k,
/// has max - min <= tolerance in every pyramid; 0, a single voxel, where there is none.
class LevelPyramid
{
public:
  /// @param grid  of more than one voxel
  /// @throws DeviceError if a byte a voxel and a byte a node of PyramidLayout do not fit the device
  LevelPyramid(Device& device, const Grid& grid);

  /// Ask that nodes be whole in one more quantity. Queues the work and returns before it is done.
  /// @param tolerances  [level] of the quantity; must not grow with the level. [0] is not used
  void Restrict(const MinMaxPyramid& ranges, const std::vector<float>& tolerances);

  /// A level a voxel, x fastest; only after Restrict.
  const Buffer<cl_uchar>& Levels() const { return this->TheLevels; }

private:
  Device& TheDevice;
  PyramidLayout Layout;
  Buffer<cl_uchar> Nodes;
  Buffer<cl_uchar> TheLevels;
  bool Restricted = false;
};
}
