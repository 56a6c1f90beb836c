#pragma once

#include "Device/HostMappedBuffer.h"
#include "Device/Sizes.h"
#include "Medium/Grid.h"
#include "Reconstruction/LightPyramidShared.h"

#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace tyndall
{
/// How wide the vectors are that the reconstruction's kernels work on: 8 on a CPU, 1 on a GPU and where rows are short.
int RowWidth(const Device& device, const Grid& grid);

/// Voxels from a row to the next that these kernels need in arrays of voxels: rounded up to a multiple of two vectors.
inline int WholeVectors(int voxels, int width)
{
  return RoundUp(voxels, 2 * width);
}

/// Volumes of rows, one for each of `fields` quantities, laid out as LightRows.cl has it.
class LightRows
{
public:
  LightRows(Device& device, const std::array<int, 3>& size, int fields, int width, const char* what);

  const std::array<int, 3>& Cells() const { return this->Size; }
  cl_int4 Layout() const { return { { this->Size[0], this->Size[1], this->Size[2], this->Stride } }; }
  int Fields() const { return this->FieldCount; }
  const Buffer<float>& Values() const { return this->Memory; }

  /// All cells on the host, x fastest, their fields side by side; and back, with what rows repeat of their ends.
  std::vector<float> Read() const;
  void Write(const std::vector<float>& cells);

  /// Cells and floats per row, as kernels take them; floats of all fields.
  static cl_int4 LayoutOf(const std::array<int, 3>& size, int width);
  static std::size_t CountOf(const std::array<int, 3>& size, int fields, int width);

private:
  /// Calls act with a cell's number, its x, a field, and the place of that in memory.
  template <class Act>
  void ForValues(const Act& act) const;

  std::array<int, 3> Size;
  int FieldCount;
  int Stride;
  int Width;
  Buffer<float> Memory;
};

/// Makes and runs the kernels that work on rows.
class RowKernels
{
public:
  RowKernels(Device& device, int width, const std::string& options = {});

  int Width() const { return this->RowWidth; }
  Device& On() const { return this->TheDevice; }

  /// A kernel of `source`, with rows as wide as these.
  cl::Kernel Kernel(const char* name, std::string_view source, const std::string& options = {}) const;

  /// Queue it for all cells of these rows, or for `layers` of them from z = `first` on.
  void Run(const cl::Kernel& kernel, const std::array<int, 3>& cells) const { this->Run(kernel, cells, 0, cells[2]); }
  void Run(const cl::Kernel& kernel, const std::array<int, 3>& cells, std::size_t first, std::size_t layers) const;

private:
  Device& TheDevice;
  int RowWidth;
  std::string Options;
};

/// An array over voxels whose rows are whole vectors: the host's own where it has such rows, else a copy with longer
/// ones that repeat the last voxel.
class WholeRows
{
public:
  /// @param array    over `volumes` grids of `size` voxels, x fastest, `components` per voxel; must outlive this
  /// @param written  kernels write it: Fetch() when they are done. Else they read it.
  WholeRows(const RowKernels& kernels, const HostMappedBuffer<float>& array, const std::array<int, 3>& size,
    int volumes, int components, bool written, const char* what);

  const cl::Buffer& Handle() const { return this->Wide.Size() > 0 ? this->Wide.Handle() : this->Own.Handle(); }

  /// Wait for the device; then the host's array holds what kernels wrote.
  void Fetch() const;

private:
  void Copy(const cl::Buffer& from, int fromRow, const cl::Buffer& to, int toRow) const;

  const RowKernels& Kernels;
  const HostMappedBuffer<float>& Own;
  int Voxels, Components;
  std::size_t Rows;
  int Pitch;
  Buffer<float> Wide;
};

/// The layout of a grid's voxels in such rows, as kernels take it.
inline cl_int4 VoxelLayout(const std::array<int, 3>& size, int width)
{
  return { { size[0], size[1], size[2], WholeVectors(size[0], width) } };
}

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
