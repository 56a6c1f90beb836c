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
/// Vector width of the reconstruction's kernels: 8 on a CPU, 1 on a GPU and for grids with short rows.
int RowWidth(const Device& device, const Grid& grid);

/// Row pitch, in voxels, that these kernels need in voxel arrays: `voxels` rounded up to a multiple of two vectors.
inline int WholeVectors(int voxels, int width)
{
  return RoundUp(voxels, 2 * width);
}

/// A device buffer of `fields` volumes, one for each quantity, with rows laid out as in LightRows.cl.
class LightRows
{
public:
  LightRows(Device& device, const std::array<int, 3>& size, int fields, int width, const char* what);

  const std::array<int, 3>& Cells() const { return this->Size; }
  cl_int4 Layout() const { return { { this->Size[0], this->Size[1], this->Size[2], this->Stride } }; }
  int Fields() const { return this->FieldCount; }
  const Buffer<float>& Values() const { return this->Memory; }

  /// Copies all cells to the host, x fastest, with the fields of a cell adjacent; Write copies them back and fills the
  /// padding of the rows.
  std::vector<float> Read() const;
  void Write(const std::vector<float>& cells);

  /// Layout for kernels: cells along x, y, z and floats per row; and the number of floats of all fields.
  static cl_int4 LayoutOf(const std::array<int, 3>& size, int width);
  static std::size_t CountOf(const std::array<int, 3>& size, int fields, int width);

private:
  /// Calls act(cell index, x, field, offset in memory) for every value.
  template <class Act>
  void ForValues(const Act& act) const;

  std::array<int, 3> Size;
  int FieldCount;
  int Stride;
  int Width;
  Buffer<float> Memory;
};

/// Compiles and launches kernels that work on rows.
class RowKernels
{
public:
  RowKernels(Device& device, int width, const std::string& options = {});

  int Width() const { return this->RowWidth; }
  Device& On() const { return this->TheDevice; }

  /// Compiles a kernel of `source` for this vector width.
  cl::Kernel Kernel(const char* name, std::string_view source, const std::string& options = {}) const;

  /// Enqueues a kernel for all cells of these rows, or for `layers` layers from z = `first` on.
  void Run(const cl::Kernel& kernel, const std::array<int, 3>& cells) const { this->Run(kernel, cells, 0, cells[2]); }
  void Run(const cl::Kernel& kernel, const std::array<int, 3>& cells, std::size_t first, std::size_t layers) const;

private:
  Device& TheDevice;
  int RowWidth;
  std::string Options;
};

/// A voxel array on the device whose rows are whole vectors: the host's own array if its rows are, else a copy with
/// longer rows, padded with the row's last voxel. The host's array must outlive this.
class WholeRows
{
public:
  /// An array that kernels read: values of a grid of `size` voxels, x fastest, `components` per voxel. Null: none.
  WholeRows(
    const RowKernels& kernels, const float* values, const std::array<int, 3>& size, int components, const char* what);
  /// An array that kernels write and Fetch copies back; may be empty.
  WholeRows(const RowKernels& kernels, std::vector<float>& values, const std::array<int, 3>& size, int components,
    const char* what);

  const cl::Buffer& Handle() const { return this->Wide.Size() > 0 ? this->Wide.Handle() : this->Own.Handle(); }

  /// Waits for the device, so that the host's array holds what kernels wrote.
  void Fetch() const;

private:
  void Copy(const cl::Buffer& from, int fromRow, const cl::Buffer& to, int toRow) const;

  const RowKernels& Kernels;
  HostMappedBuffer<float> Own;
  int Voxels, Components;
  std::size_t Rows;
  int Pitch;
  Buffer<float> Wide;
};

/// Layout of a grid's voxels in such rows, for kernels.
inline cl_int4 VoxelLayout(const std::array<int, 3>& size, int width)
{
  return { { size[0], size[1], size[2], WholeVectors(size[0], width) } };
}

/// Position of a block in the grid, for a pyramid over the block: its lower levels cover the block, its upper levels
/// the whole grid.
struct PartOfPyramid
{
  std::array<int, 3> whole = {}; ///< voxels of the grid
  std::array<int, 3> first = {}; ///< first voxel of the block, multiples of 8
  int shared = LevelsAtMost;     ///< the highest level that covers only the block
};

/// A pyramid of volumes: a grid and its means or sums over 2x2x2, 4x4x4, ... voxels, level after level in one buffer,
/// in rows as in LightRows.cl. If a grid has an odd size, its last voxel is treated as if it were repeated.
class LightPyramid
{
public:
  /// How a level is computed from the next finer one.
  enum class Down
  {
    Gauss,     ///< Gaussian filter of 4x4x4 cells with variance four, separable (Pfeuti 2009, section 3.2.4)
    Sum,       ///< sum of 2x2x2 cells
    MeanOfLit, ///< mean of the nonzero ones of 2x2x2 cells (listing B.2)
  };

  /// @param levels  number of levels above the grid, at most LevelsAtMost
  /// @param part    the grid's place in a larger grid
  LightPyramid(const RowKernels& kernels, const Grid& grid, int fields, int levels, const char* what,
    const PartOfPyramid& part = {});

  /// Copies a voxel array of 1 or 3 components into the fields of level 0, from field `first` on.
  void Fill(const WholeRows& voxels, int components, int first);

  /// Enqueues the kernels that compute all levels of the block from level 0.
  void Build(Down down);
  /// Computes the levels of the whole grid, above the shared level.
  /// @param cells  the shared level of the whole grid
  void BuildAbove(Down down, const std::vector<float>& cells);
  /// Copies all cells of a level to the host, x fastest, with the fields of a cell adjacent.
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
  std::vector<cl::Buffer> Parts; ///< subbuffers of Memory, one per level
};
}
