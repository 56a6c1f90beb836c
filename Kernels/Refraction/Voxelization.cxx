#include "Voxelization.h"

#include "SampleLattice.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>

namespace tyndall
{
namespace
{
constexpr int LargestSampleCount = 16;
constexpr std::size_t WorkGroup = 64;

cl::NDRange Groups(std::size_t items)
{
  return cl::NDRange((items + WorkGroup - 1) / WorkGroup * WorkGroup);
}

/// Words of 32 bits in a column.
int WordsOf(const Grid& grid, int axis, int voxelsOfWord)
{
  return (grid.size[axis] + voxelsOfWord - 1) / voxelsOfWord;
}

/// Rows of voxels whose columns of samples take about `bytes`.
int VoxelsOfSlab(const SampleColumns& columns, int voxels, int words, std::size_t bytes)
{
  const std::size_t rowsOfVoxel = static_cast<std::size_t>(columns.count[1] / voxels);
  const std::size_t row = static_cast<std::size_t>(columns.count[0]) * words * sizeof(cl_uint);
  return static_cast<int>(std::clamp<std::size_t>(bytes / (row * rowsOfVoxel), 1, voxels));
}

/// Puts the crossings of meshes with some rows of columns into a buffer.
class CrossingMarker
{
public:
  CrossingMarker(Device& device, const SampleColumns& columns, int words, const std::string& options)
    : TheDevice(device)
    , Columns(columns)
    , Words(words)
    , Kernel(device.Kernel("mark_crossings", { kernel_source::Voxelization }, options))
  {
  }

  void Mark(const LatticeMesh& mesh, int firstRow, int endRow, Buffer<cl_uint>& marks)
  {
    marks.Fill(0);
    const std::vector<cl_uint4> tiles = mesh.Tiles(this->Columns, firstRow, endRow);
    if (tiles.empty())
    {
      return;
    }
    if (this->Tiles.Size() < tiles.size())
    {
      this->Tiles = Buffer<cl_uint4>(this->TheDevice, tiles.size() + tiles.size() / 4, "pieces of the mesh");
    }
    this->TheDevice.Queue().enqueueWriteBuffer(
      this->Tiles.Handle(), CL_TRUE, 0, tiles.size() * sizeof(cl_uint4), tiles.data());
    With(this->Kernel, static_cast<cl_int>(tiles.size()), this->Tiles, mesh.Points(), mesh.Triangles(),
      this->Columns.pitch, this->Columns.samples, this->Columns.count[0], this->Words, firstRow, marks);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      this->Kernel, cl::NullRange, Groups(tiles.size()), cl::NDRange(WorkGroup));
  }

private:
  Device& TheDevice;
  SampleColumns Columns;
  int Words;
  cl::Kernel Kernel;
  Buffer<cl_uint4> Tiles;
};

std::string OptionsOf(int axis, int samples, bool fromAbove, bool winding)
{
  return "-DAXIS=" + std::to_string(axis) + " -DSAMPLES=" + std::to_string(samples) +
    " -DFROM_ABOVE=" + std::to_string(fromAbove) + " -DWINDING=" + std::to_string(winding);
}

/// How many samples of each voxel are in each mesh, slab by slab.
class Voxelization
{
public:
  Voxelization(Device& device, const Grid& grid, const std::vector<const TriangleMesh*>& meshes,
    const VoxelizationSettings& settings)
    : TheDevice(device)
    , TheGrid(grid)
    , Samples(settings.samples)
    , Lattice(grid, settings.samples, meshes)
    , Columns(grid, settings.columnAxis, settings.samples, this->Lattice.Pitch())
    , Words(WordsOf(grid, settings.columnAxis, 32 / settings.samples))
    , Rows(VoxelsOfSlab(this->Columns, grid.size[this->Columns.up], this->Words, settings.slabBytes))
    , Options(OptionsOf(settings.columnAxis, settings.samples, settings.fromAbove, false))
    , Marker(device, this->Columns, this->Words, this->Options)
    , Fill(device.Kernel("fill_columns", { kernel_source::Voxelization }, this->Options))
    , Count(device.Kernel("count_samples", { kernel_source::Voxelization }, this->Options))
  {
    for (const TriangleMesh* mesh : meshes)
    {
      this->Meshes.emplace_back(device, this->Lattice, *mesh);
      this->Counts.emplace_back(device, grid.VoxelCount(), "the voxels' samples inside");
    }
    const std::size_t words = static_cast<std::size_t>(this->ColumnCount(this->Rows)) * this->Words;
    this->Bits = Buffer<cl_uint>(device, words, "a slab of the fine grid");
    // Without a second mesh nothing is ever claimed, and the kernel is handed an empty buffer.
    this->Claimed = Buffer<cl_uint>(device, meshes.size() > 1 ? words : 0, "samples of later meshes");
  }

  std::vector<Buffer<cl_ushort>> Run(const Monitor& monitor)
  {
    const int rows = this->TheGrid.size[this->Columns.up];
    for (int first = 0; first < rows; first += this->Rows)
    {
      Report(monitor, static_cast<double>(first) / rows);
      this->RunSlab(first, std::min(first + this->Rows, rows));
      this->TheDevice.Finish();
    }
    return std::move(this->Counts);
  }

private:
  int ColumnCount(int rowsOfVoxels) const { return this->Columns.count[0] * rowsOfVoxels * this->Samples; }

  void RunSlab(int first, int end)
  {
    if (this->Claimed.Size() > 0)
    {
      this->Claimed.Fill(0);
    }
    for (std::size_t m = this->Meshes.size(); m-- > 0;)
    {
      this->Marker.Mark(this->Meshes[m], first * this->Samples, end * this->Samples, this->Bits);
      const int columns = this->ColumnCount(end - first);
      With(this->Fill, columns, this->Words, this->Bits);
      this->TheDevice.Queue().enqueueNDRangeKernel(
        this->Fill, cl::NullRange, Groups(static_cast<std::size_t>(columns)), cl::NDRange(WorkGroup));
      this->CountSlab(first, end, this->Counts[m]);
    }
  }

  void CountSlab(int first, int end, Buffer<cl_ushort>& counts)
  {
    const std::array<int, 3>& size = this->TheGrid.size;
    const std::array<int, 3> stride = { 1, size[0], size[0] * size[1] };
    const int columns = size[this->Columns.across];
    const cl_ulong voxel = static_cast<cl_ulong>(first) * static_cast<cl_ulong>(stride[this->Columns.up]);
    With(this->Count, size[this->Columns.axis], columns, end - first, this->Words, this->Bits, this->Claimed,
      static_cast<cl_int>(this->Claimed.Size() > 0), counts, stride[this->Columns.axis], stride[this->Columns.across],
      stride[this->Columns.up], voxel);
    const std::size_t across = (static_cast<std::size_t>(columns) + WorkGroup - 1) / WorkGroup * WorkGroup;
    this->TheDevice.Queue().enqueueNDRangeKernel(this->Count, cl::NullRange,
      cl::NDRange(across, static_cast<std::size_t>(end - first)), cl::NDRange(WorkGroup, 1));
  }

  Device& TheDevice;
  const Grid& TheGrid;
  int Samples;
  SampleLattice Lattice;
  SampleColumns Columns;
  int Words;
  int Rows; ///< of voxels in a slab
  std::string Options;
  CrossingMarker Marker;
  cl::Kernel Fill, Count;
  std::vector<LatticeMesh> Meshes;
  std::vector<Buffer<cl_ushort>> Counts;
  Buffer<cl_uint> Bits, Claimed;
};

void Merge(WindingNumbers& windings, const cl_int4& ofColumn, const std::array<int, 3>& voxel)
{
  windings.lowest = std::min(windings.lowest, ofColumn.s[0]);
  windings.highest = std::max(windings.highest, ofColumn.s[1]);
  if (windings.oddVoxels == 0 && ofColumn.s[2] > 0)
  {
    windings.firstOddVoxel = voxel;
  }
  windings.oddVoxels += static_cast<std::size_t>(ofColumn.s[2]);
}
}

void Check(const VoxelizationSettings& settings)
{
  if (settings.samples < 1 || settings.samples > LargestSampleCount)
  {
    throw InvalidInput("The supersampling factor is " + std::to_string(settings.samples) + "; it must be 1 to " +
      std::to_string(LargestSampleCount) + ".");
  }
  if (settings.columnAxis < 0 || settings.columnAxis > 2)
  {
    throw InvalidInput("Columns run along axis 0, 1 or 2, not " + std::to_string(settings.columnAxis) + ".");
  }
}

std::vector<Buffer<cl_ushort>> CountSamplesInside(Device& device, const Grid& grid,
  const std::vector<const TriangleMesh*>& meshes, const VoxelizationSettings& settings, const Monitor& monitor)
{
  Check(settings);
  return Voxelization(device, grid, meshes, settings).Run(monitor);
}

WindingNumbers FindWindings(
  Device& device, const Grid& grid, const TriangleMesh& mesh, bool inverted, const Monitor& monitor)
{
  const SampleLattice lattice(grid, 1, { &mesh });
  const SampleColumns columns(grid, 0, 1, lattice.Pitch());
  const LatticeMesh onLattice(device, lattice, mesh);
  const int words = WordsOf(grid, 0, 4);
  const int slab = VoxelsOfSlab(columns, grid.size[2], words, VoxelizationSettings().slabBytes);
  const std::string options = OptionsOf(0, 1, false, true);
  CrossingMarker marker(device, columns, words, options);
  cl::Kernel find = device.Kernel("find_windings", { kernel_source::Voxelization }, options);
  const std::size_t most = static_cast<std::size_t>(columns.count[0]) * slab;
  Buffer<cl_uint> marks(device, most * words, "crossings of the mesh");
  Buffer<cl_int4> found(device, most, "winding numbers");
  std::vector<cl_int4> ofColumns(most);

  WindingNumbers windings;
  for (int first = 0; first < grid.size[2]; first += slab)
  {
    Report(monitor, static_cast<double>(first) / grid.size[2]);
    const int end = std::min(first + slab, grid.size[2]);
    const int count = columns.count[0] * (end - first);
    marker.Mark(onLattice, first, end, marks);
    With(find, count, words, grid.size[0], inverted ? -1 : 1, marks, found);
    device.Queue().enqueueNDRangeKernel(
      find, cl::NullRange, Groups(static_cast<std::size_t>(count)), cl::NDRange(WorkGroup));
    found.Read(ofColumns.data());
    for (int c = 0; c < count; ++c)
    {
      Merge(windings, ofColumns[static_cast<std::size_t>(c)],
        { ofColumns[static_cast<std::size_t>(c)].s[3], c % columns.count[0], first + c / columns.count[0] });
    }
  }
  return windings;
}
}
