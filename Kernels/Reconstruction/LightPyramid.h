#pragma once

#include "Reconstruction/LightPyramidShared.h"
#include "Reconstruction/LightRows.h"

#include <vector>

namespace tyndall
{
/// A pyramid over a part of a grid, whose upper levels are those of all of it.
struct PartOfPyramid
{
  std::array<int, 3> whole = {}; ///< voxels of the grid
  std::array<int, 3> first = {}; ///< the part's first one, multiples of 8
  int shared = LevelsAtMost;     ///< the highest level that is of the part
};

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
  /// @param part    of which the grid is
  LightPyramid(const RowKernels& kernels, const Grid& grid, int fields, int levels, const char* what,
    const PartOfPyramid& part = {});

  /// Put an array of voxels of 1 or 3 components into fields `first` and on of level 0.
  void Fill(const WholeRows& voxels, int components, int first);

  /// Queue the making of all levels of the grid from level 0.
  void Build(Down down);
  /// The others, of a part.
  /// @param cells  of the whole's shared level
  void BuildAbove(Down down, const std::vector<float>& cells);
  /// All cells of a level on the host, x fastest, their fields side by side.
  std::vector<float> Read(int level) const;

  const cl::Buffer& Values() const { return this->Memory.Handle(); }
  const Buffer<PyramidLevels>& Levels() const { return this->Told; }

private:
  std::size_t BytesOf(std::size_t level) const;
  void Copy(const cl::Buffer& from, const cl::Buffer& to, std::size_t bytes) const;

  const RowKernels& Kernels;
  PartOfPyramid Part;
  std::vector<std::array<int, 3>> Sizes;
  int Fields;
  PyramidLevels Where = {};
  Buffer<PyramidLevels> Told; ///< Where, for kernels
  Buffer<float> Memory;
  std::vector<cl::Buffer> Parts; ///< of Memory, a level each
};
}
