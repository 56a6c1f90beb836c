#include "Refraction/Voxelization/Voxelization.h"

#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "Medium/GridOfBox.h"
#include "Refraction/Voxelization/SampleLattice.h"
#include "Refraction/Voxelization/WindingNumbers.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

namespace tyndall
{
namespace
{
SampleColumns Along(int axis, const Grid& grid, const SampleColumns& like)
{
  return { grid, axis, like.samplesOfVoxel, like.pitch };
}
}

SurfaceFraction::SurfaceFraction(
  Device& device, const Grid& grid, const SampleColumns& columns, int words, std::size_t voxels, bool several)
  : TheDevice(device)
  , Size(grid.size)
  , Bits(columns)
  , Words(words)
  , Several(several)
  , Columns{ Along(0, grid, columns), Along(1, grid, columns), Along(2, grid, columns) }
  , Corrections(device, voxels, "fractions of samples")
  , Taken(device, several ? voxels : 0, "samples of later meshes in voxels")
{
  const auto kernel = [&](const char* name, int axis) {
    const std::string options =
      CrossingOptions(columns.samplesOfVoxel, false) + Define("AXIS", axis) + Define("BIT_AXIS", columns.axis);
    return device.Kernel(name, kernel_source::SurfaceFraction, options);
  };
  for (int axis = 0; axis < 3; ++axis)
  {
    this->MeasureAlong[axis] = kernel("measure_crossings", axis);
  }
  this->RefineCounts = kernel("refine_counts", 0);
  this->ClaimSamples = kernel("claim_samples", 0);
}

void SurfaceFraction::Begin()
{
  if (this->Several)
  {
    this->Taken.Fill({});
  }
}

void SurfaceFraction::Measure(const LatticeMesh& mesh, int orientation, const SampleSlab& slab,
  const Buffer<cl_uint>& bits, const Buffer<cl_uint>& claimed)
{
  this->Corrections.Fill(0);
  SampleBox box = { { 0, 0, 0 }, {} };
  for (int axis = 0; axis < 3; ++axis)
  {
    box.end[axis] = this->Size[axis] * this->Bits.samplesOfVoxel;
  }
  box.first[this->Bits.up] = slab.firstVoxel * this->Bits.samplesOfVoxel;
  box.end[this->Bits.up] = slab.endVoxel * this->Bits.samplesOfVoxel;
  for (int axis = 0; axis < 3; ++axis)
  {
    const SampleColumns& columns = this->Columns[axis];
    const std::vector<cl_uint4> tiles = mesh.Tiles(columns, box);
    if (tiles.empty())
    {
      continue;
    }
    Buffer<cl_uint4>& onDevice = this->Tiles[axis];
    if (onDevice.Size() < tiles.size())
    {
      onDevice = Buffer<cl_uint4>(this->TheDevice, tiles.size() + tiles.size() / 4, "pieces of the mesh");
    }
    onDevice.Write(tiles.data(), tiles.size());
    cl::Kernel& kernel = this->MeasureAlong[axis];
    With(kernel, static_cast<cl_int>(tiles.size()), onDevice, mesh.Points(), mesh.Triangles(), columns.pitch,
      columns.samples, bits, static_cast<cl_int>(this->Several), claimed, this->Taken, this->Words, this->Bits.count[0],
      slab.firstRow, slab.firstVoxel, this->VoxelsOf(slab), orientation, this->Corrections);
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, CrossingRange(tiles.size()), CrossingGroup());
  }
}

void SurfaceFraction::Refine(
  const SampleSlab& slab, const Buffer<cl_uint>& bits, Buffer<cl_uint>& claimed, Buffer<cl_ushort>& counts)
{
  const cl_int4 voxels = this->VoxelsOf(slab);
  With(this->RefineCounts, voxels, this->Corrections, static_cast<cl_int>(this->Several), this->Taken, bits,
    this->Words, this->Bits.count[0], slab.firstRow, slab.firstVoxel, counts);
  const std::size_t count = static_cast<std::size_t>(voxels.s[0]) * voxels.s[1] * voxels.s[2];
  this->TheDevice.Queue().enqueueNDRangeKernel(
    this->RefineCounts, cl::NullRange, CrossingRange(count), CrossingGroup());
  if (this->Several)
  {
    for (int row = slab.firstRow; row < slab.firstVoxel * this->Bits.samplesOfVoxel; ++row)
    {
      this->Claim(slab, row, bits, claimed);
    }
    for (int row = slab.endVoxel * this->Bits.samplesOfVoxel; row < slab.endRow; ++row)
    {
      this->Claim(slab, row, bits, claimed);
    }
  }
}

void SurfaceFraction::Claim(const SampleSlab& slab, int row, const Buffer<cl_uint>& bits, Buffer<cl_uint>& claimed)
{
  const int words = this->Bits.count[0] * this->Words;
  With(this->ClaimSamples, static_cast<cl_ulong>(row - slab.firstRow) * words, words, bits, claimed);
  this->TheDevice.Queue().enqueueNDRangeKernel(
    this->ClaimSamples, cl::NullRange, CrossingRange(static_cast<std::size_t>(words)), CrossingGroup());
}

cl_int4 SurfaceFraction::VoxelsOf(const SampleSlab& slab) const
{
  cl_int4 voxels = { { this->Size[0], this->Size[1], this->Size[2], 0 } };
  voxels.s[this->Bits.up] = slab.endVoxel - slab.firstVoxel;
  return voxels;
}

namespace
{
constexpr int LargestSampleCount = 16;
/// Maximum number of voxels in a slab, unless one row has more.
constexpr std::size_t SlabVoxels = std::size_t(4) << 20;

/// Number of 32-bit words in a column.
int WordsOf(const Grid& grid, int axis, int voxelsOfWord)
{
  return PartsOf(grid.size[axis], voxelsOfWord);
}

std::vector<const TriangleMesh*> TrianglesOf(const std::vector<OrientedMesh>& meshes)
{
  std::vector<const TriangleMesh*> triangles;
  for (const OrientedMesh& mesh : meshes)
  {
    triangles.push_back(mesh.mesh);
  }
  return triangles;
}

std::size_t VoxelsOfRow(const SampleColumns& columns, const Grid& grid)
{
  return grid.VoxelCount() / grid.size[columns.up];
}

/// Number of rows of voxels whose columns of samples take about `bytes`.
int RowsOfSlab(const SampleColumns& columns, const Grid& grid, int words, std::size_t bytes)
{
  const std::size_t row = static_cast<std::size_t>(columns.count[0]) * columns.samplesOfVoxel * words * sizeof(cl_uint);
  const std::size_t rows = std::min(bytes / row, SlabVoxels / VoxelsOfRow(columns, grid));
  return static_cast<int>(std::clamp<std::size_t>(rows, 1, static_cast<std::size_t>(grid.size[columns.up])));
}

/// Counts the samples of each voxel inside each mesh, slab by slab.
class Voxelization
{
public:
  Voxelization(Device& device, const Grid& grid, const CountedVoxels& counted, const std::vector<OrientedMesh>& meshes,
    const VoxelizationSettings& settings)
    : TheDevice(device)
    , Whole(grid)
    , Counted(counted)
    , TheGrid(GridOfBox(counted.box, grid))
    , Samples(settings.samples)
    , Lattice(grid, settings.samples, TrianglesOf(meshes))
    , Columns(TheGrid, settings.columnAxis, settings.samples, this->Lattice.Pitch())
    , Words(WordsOf(TheGrid, settings.columnAxis, 32 / settings.samples))
    , Rows(RowsOfSlab(this->Columns, TheGrid, this->Words, settings.slabBytes))
    , FromAbove(settings.fromAbove)
    , Marker(device, this->Columns, this->Words, settings.fromAbove, CrossingOptions(settings.samples, false))
    , Fill(device.Kernel("fill_columns", kernel_source::Voxelization, CrossingOptions(settings.samples, false)))
    , Count(device.Kernel("count_samples", kernel_source::Voxelization, CrossingOptions(settings.samples, false)))
    , Oriented(meshes)
    , Odd(device, meshes.size() * TheGrid.size[this->Columns.up],
        "rows of voxels with samples that a mesh encloses twice")
  {
    for (const OrientedMesh& mesh : meshes)
    {
      this->Meshes.emplace_back(device, this->Lattice.From(counted.box.first), *mesh.mesh);
    }
    const std::size_t voxels = this->Rows * VoxelsOfRow(this->Columns, this->TheGrid);
    const auto columns =
      static_cast<std::size_t>(this->Columns.count[0]) * (this->Rows * this->Samples + 2 * RowsAround(settings));
    this->Bits = Buffer<cl_uint>(device, columns * this->Words, "a slab of the fine grid");
    this->Sums = Buffer<cl_uint>(device, columns, "sums of crossings");
    // With a single mesh nothing is ever claimed, and the kernel receives an empty buffer.
    this->Claimed = Buffer<cl_uint>(device, meshes.size() > 1 ? columns * this->Words : 0, "samples of later meshes");
    this->Counts = Buffer<cl_ushort>(device, voxels, "a slab of the voxels' samples inside");
    if (settings.fractions)
    {
      this->Fractions.emplace(device, this->TheGrid, this->Columns, this->Words, voxels, meshes.size() > 1);
    }
    this->Odd.Fill(0);
  }

  void Run(const std::function<void(const SamplesInside&)>& take, const Monitor& monitor)
  {
    const int rows = this->TheGrid.size[this->Columns.up];
    for (int first = 0; first < rows; first += this->Rows)
    {
      Report(monitor, static_cast<double>(first) / rows);
      this->RunSlab(first, std::min(first + this->Rows, rows), take);
      this->TheDevice.Finish();
    }
  }

  std::vector<WindingNumbers> Windings(const Monitor& monitor) const
  {
    const std::vector<cl_int> odd = this->Odd.Read();
    const int up = this->Columns.up;
    auto begin = odd.begin() + (this->Counted.own.first[up] - this->Counted.box.first[up]);
    std::vector<WindingNumbers> windings;
    for (const OrientedMesh& mesh : this->Oriented)
    {
      windings.push_back(this->WindingsOf(mesh, { begin, begin + this->Counted.own.size[up] }, monitor));
      begin += this->TheGrid.size[up];
    }
    return windings;
  }

private:
  /// Rows of samples needed on either side of a slab.
  static int RowsAround(const VoxelizationSettings& settings) { return settings.fractions ? 1 : 0; }

  /// @param rows  one per row of the own voxels: nonzero if it may have odd samples
  WindingNumbers WindingsOf(const OrientedMesh& mesh, const std::vector<cl_int>& rows, const Monitor& monitor) const
  {
    const VoxelBox& own = this->Counted.own;
    if (own.VoxelCount() == 0 || std::all_of(rows.begin(), rows.end(), [](cl_int row) { return row == 0; }))
    {
      return {};
    }
    const LatticeMesh onLattice(this->TheDevice, this->Lattice.From(own.first), *mesh.mesh);
    const SampleColumns columns(GridOfBox(own, this->Whole), this->Columns.axis, this->Samples, this->Columns.pitch);
    return FindWindings(this->TheDevice, this->Whole, own, onLattice, columns, rows, mesh.orientation < 0, monitor);
  }

  SampleSlab RowsOf(int first, int end) const
  {
    const int around = this->Fractions ? 1 : 0;
    return { first, end, std::max(first * this->Samples - around, 0),
      std::min(end * this->Samples + around, this->Columns.count[1]) };
  }

  void RunSlab(int first, int end, const std::function<void(const SamplesInside&)>& take)
  {
    if (this->Claimed.Size() > 0)
    {
      this->Claimed.Fill(0);
    }
    if (this->Fractions)
    {
      this->Fractions->Begin();
    }
    const SampleSlab slab = this->RowsOf(first, end);
    for (std::size_t m = this->Meshes.size(); m-- > 0;)
    {
      this->Marker.Mark(this->Meshes[m], slab.firstRow, slab.endRow, this->Bits, this->Sums);
      const int columns = this->Columns.count[0] * (slab.endRow - slab.firstRow);
      const int firstOdd = static_cast<int>(m) * this->TheGrid.size[this->Columns.up];
      With(this->Fill, columns, this->Columns.count[0], this->Words, this->FromAbove, this->Bits, this->Sums,
        this->Oriented[m].orientation, this->Odd, firstOdd, slab.firstRow);
      this->TheDevice.Queue().enqueueNDRangeKernel(
        this->Fill, cl::NullRange, CrossingRange(static_cast<std::size_t>(columns)), CrossingGroup());
      if (this->Fractions)
      {
        this->Fractions->Measure(this->Meshes[m], this->Oriented[m].orientation, slab, this->Bits, this->Claimed);
      }
      this->CountSlab(slab);
      if (this->Fractions)
      {
        this->Fractions->Refine(slab, this->Bits, this->Claimed, this->Counts);
      }
      take(this->SlabOf(m, first, end));
    }
  }

  void CountSlab(const SampleSlab& slab)
  {
    const int rows = slab.endVoxel - slab.firstVoxel;
    const int skipped = slab.firstVoxel * this->Samples - slab.firstRow;
    const int units = this->Fractions ? 1 : UnitsOfSample(this->Samples);
    const std::array<int, 3>& size = this->TheGrid.size;
    const std::array<int, 3> stride = { 1, size[0], size[0] * (this->Columns.up == 1 ? rows : size[1]) };
    const int columns = size[this->Columns.across];
    With(this->Count, size[this->Columns.axis], columns, rows, this->Words, skipped, this->Bits, this->Claimed,
      static_cast<cl_int>(this->Claimed.Size() > 0), this->Counts, units, stride[this->Columns.axis],
      stride[this->Columns.across], stride[this->Columns.up]);
    const std::size_t group = CrossingGroup().get()[0];
    this->TheDevice.Queue().enqueueNDRangeKernel(this->Count, cl::NullRange,
      cl::NDRange(RoundUp(static_cast<std::size_t>(columns), group), static_cast<std::size_t>(rows)),
      cl::NDRange(group, 1));
  }

  SamplesInside SlabOf(std::size_t mesh, int first, int end) const
  {
    const std::size_t row = this->TheGrid.size[0];
    const std::size_t layer = row * this->TheGrid.size[1];
    const std::size_t layers = this->TheGrid.size[2];
    return this->Columns.up == 2 ? SamplesInside{ mesh, this->Counts, first * layer, (end - first) * layer, 0, 1 }
                                 : SamplesInside{ mesh, this->Counts, first * row, (end - first) * row, layer, layers };
  }

  Device& TheDevice;
  const Grid& Whole;
  const CountedVoxels Counted;
  const Grid TheGrid; ///< the box whose samples are counted
  int Samples;
  SampleLattice Lattice;
  SampleColumns Columns;
  int Words;
  int Rows; ///< rows of voxels in a slab
  cl_int FromAbove;
  CrossingMarker Marker;
  cl::Kernel Fill, Count;
  std::vector<OrientedMesh> Oriented;
  std::vector<LatticeMesh> Meshes;
  Buffer<cl_uint> Bits, Sums, Claimed;
  Buffer<cl_ushort> Counts;
  std::optional<SurfaceFraction> Fractions; ///< present if the settings ask for fractions
  Buffer<cl_int> Odd;                       ///< for each mesh's rows of voxels: nonzero where FindWindings is to look
};
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

std::vector<WindingNumbers> CountSamplesInside(Device& device, const Grid& grid, const CountedVoxels& counted,
  const std::vector<OrientedMesh>& meshes, const VoxelizationSettings& settings,
  const std::function<void(const SamplesInside&)>& take, const Monitor& monitor)
{
  Check(settings);
  Voxelization voxelization(device, grid, counted, meshes, settings);
  voxelization.Run(take, monitor);
  return voxelization.Windings(monitor ? [&monitor](double) { return monitor(1.0); } : Monitor());
}

std::vector<WindingNumbers> CountSamplesInside(Device& device, const Grid& grid,
  const std::vector<OrientedMesh>& meshes, const VoxelizationSettings& settings,
  const std::function<void(const SamplesInside&)>& take, const Monitor& monitor)
{
  return CountSamplesInside(device, grid, CountedVoxels::All(grid), meshes, settings, take, monitor);
}
}
