#pragma once

#include "Reconstruction/LightPyramidShared.h"
#include "Reconstruction/WholeRows.h"

#include <vector>

namespace tyndall
{
/// Volumes over a grid and their means or sums over 2x2x2, 4x4x4, ... voxels, level after level in one buffer, as rows
/// of LightRows.cl. A grid of an odd size is treated as if its last voxel were repeated.
class LightPyramid
{
public:
  /// How a level follows from the one below.
  enum class Down
  {
    Gauss,     ///< 4x4x4 of variance four, separable (Pfeuti 2009, section 3.2.4)
    Sum,       ///< of 2x2x2
    MeanOfLit, ///< of those of 2x2x2 that are not 0 (listing B.2)
  };

  /// @param levels  above the grid, at most LevelsAtMost
  LightPyramid(const RowKernels& kernels, const Grid& grid, int fields, int levels, const char* what);

  /// Put an array of voxels of 1 or 3 components into fields `first` and on of level 0.
  void Fill(const WholeRows& voxels, int components, int first);

  /// Queue the making of all levels from level 0.
  void Build(Down down);

  const cl::Buffer& Values() const { return this->Memory.Handle(); }
  const Buffer<PyramidLevels>& Levels() const { return this->Told; }

private:
  const RowKernels& Kernels;
  std::vector<std::array<int, 3>> Sizes;
  int Fields;
  PyramidLevels Where = {};
  Buffer<PyramidLevels> Told; ///< Where, for kernels
  Buffer<float> Memory;
  std::vector<cl::Buffer> Parts; ///< of Memory, a level each
};
}
