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
/// Vector width of the reconstruction's kernels: 8 on a CPU; 1 on a GPU, and for grids with short rows.
int RowWidth(const Device& device, const Grid& grid);

/// Row pitch of voxel arrays, in voxels, that the reconstruction's kernels need: `voxels` rounded up to a multiple of
/// two vectors of `width`.
inline int WholeVectors(int voxels, int width)
{
  return RoundUp(voxels, 2 * width);
}

/// Device buffer of `fields` volumes of cells, one volume per quantity, with rows laid out as in LightRows.cl.
class LightRows
{
public:
  LightRows(Device& device, const std::array<int, 3>& size, int fields, int width, const char* what);

  const std::array<int, 3>& Cells() const { return this->Size; } ///< number of cells along x, y, z
  /// Layout for kernels: numbers of cells along x, y, z, and number of floats per row.
  cl_int4 Layout() const { return { { this->Size[0], this->Size[1], this->Size[2], this->Stride } }; }
  int Fields() const { return this->FieldCount; }
  const Buffer<float>& Values() const { return this->Memory; }

  /// Copies all cells to the host, x fastest, with the fields of a cell adjacent.
  std::vector<float> Read() const;
  void Write(const std::vector<float>& cells); ///< inverse of Read; also fills the padding of the rows

  /// Layout for kernels: numbers of cells along x, y, z, and number of floats per row.
  static cl_int4 LayoutOf(const std::array<int, 3>& size, int width);
  /// Number of floats of a buffer for `fields` quantities per cell, padding included.
  static std::size_t CountOf(const std::array<int, 3>& size, int fields, int width);

private:
  /// Calls act(cell index, x, field, offset in memory) for each field (quantity) of each cell.
  template <class Act>
  void ForValues(const Act& act) const;

  std::array<int, 3> Size;
  int FieldCount;
  int Stride;
  int Width;
  Buffer<float> Memory;
};

/// Compiles and launches kernels that process the rows of LightRows or of voxel arrays.
class RowKernels
{
public:
  RowKernels(Device& device, int width);

  int Width() const { return this->RowWidth; }
  Device& On() const { return this->TheDevice; }

  /// Compiles a kernel of `source` for the vector width.
  cl::Kernel Kernel(const char* name, std::string_view source, const std::string& options = {}) const;

  /// Enqueues a kernel for all cells of a volume, or for its `layers` layers from z = `first` on.
  void Run(const cl::Kernel& kernel, const std::array<int, 3>& cells) const { this->Run(kernel, cells, 0, cells[2]); }
  void Run(const cl::Kernel& kernel, const std::array<int, 3>& cells, std::size_t first, std::size_t layers) const;

private:
  Device& TheDevice;
  int RowWidth;
};

/// A voxel array on the device, with rows that are a multiple of two vectors. If the host's rows already are, it is the
/// host's own array. Otherwise it is a copy with rows padded by their last voxel. The host's array is referenced and
/// must outlive this object.
class WholeRows
{
public:
  /// Provides an array that kernels read: values of a grid of `size` voxels, x fastest, `components` per voxel. Null:
  /// no array.
  WholeRows(
    const RowKernels& kernels, const float* values, const std::array<int, 3>& size, int components, const char* what);
  /// Provides an array that kernels write, and that Fetch copies back to `values`. If `values` is empty, there is no
  /// array.
  WholeRows(const RowKernels& kernels, std::vector<float>& values, const std::array<int, 3>& size, int components,
    const char* what);

  const cl::Buffer& Handle() const { return this->Wide.Size() > 0 ? this->Wide.Handle() : this->Own.Handle(); }

  /// Waits for the device. Afterwards the host's array holds the values that kernels wrote.
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

/// Layout of voxels for kernels that read WholeRows: number of voxels along x, y, z, and pitch of rows in voxels.
inline cl_int4 VoxelLayout(const std::array<int, 3>& size, int width)
{
  return { { size[0], size[1], size[2], WholeVectors(size[0], width) } };
}

/// Position of a block in the domain, for a pyramid whose lower levels cover the block and whose upper levels cover the
/// domain.
struct PartOfPyramid
{
  std::array<int, 3> whole = {}; ///< number of voxels of the domain along x, y, z
  std::array<int, 3> first = {}; ///< first voxel of the block in the domain, multiples of 8
  int shared = LevelsAtMost;     ///< "shared level": highest level that covers only the block, not the domain
};

/// A pyramid of volumes: a grid and its means or sums over 2x2x2, 4x4x4, ... voxels, level after level in one buffer,
/// in rows as in LightRows.cl. If the size of a grid is odd, its last voxel is treated as if it were repeated.
class LightPyramid
{
public:
  /// Method by which a level is computed from the next finer one.
  enum class Down
  {
    Gauss,     ///< Gaussian filter of 4x4x4 cells with variance four, separable (Pfeuti 2009, section 3.2.4)
    Sum,       ///< sum of 2x2x2 cells
    MeanOfLit, ///< mean of the nonzero cells among 2x2x2 cells (listing B.2)
  };

  /// Allocates the pyramid of a grid.
  /// @param fields  number of quantities per cell
  /// @param levels  number of levels above the grid, at most LevelsAtMost
  /// @param part    position in the domain of the grid, if it is a block
  LightPyramid(const RowKernels& kernels, const Grid& grid, int fields, int levels, const char* what,
    const PartOfPyramid& part = {});

  /// Copies a voxel array of 1 or 3 components to level 0 of the pyramid, as the fields (quantities of a cell) from
  /// number `first` on.
  void Fill(const WholeRows& voxels, int components, int first);

  /// Enqueues the kernels that compute the levels above level 0 that cover only the block, up to PartOfPyramid::shared.
  void Build(Down down);
  /// Computes the levels above the shared level (PartOfPyramid::shared), which cover the domain.
  /// @param cells  all cells of the shared level of the domain, in the order of Read
  void BuildAbove(Down down, const std::vector<float>& cells);
  /// Copies all cells of a level to the host, x fastest, with the fields of a cell adjacent.
  std::vector<float> Read(int level) const;

  const cl::Buffer& Values() const { return this->Memory.Handle(); } ///< buffer of all levels
  const Buffer<PyramidLevels>& Levels() const { return this->Told; } ///< positions and layouts of the levels in Values

private:
  std::size_t BytesOf(std::size_t level) const;
  void Copy(const cl::Buffer& from, const cl::Buffer& to, std::size_t bytes) const;

  const RowKernels& Kernels;
  PartOfPyramid Part;
  std::vector<std::array<int, 3>> Sizes; ///< number of cells along x, y, z of each level
  int Fields;
  PyramidLevels Where = {};
  Buffer<PyramidLevels> Told; ///< copy of `Where`, the layout of the levels, on the device
  Buffer<float> Memory;
  std::vector<cl::Buffer> Parts; ///< subbuffers of Memory, one per level
};
}
