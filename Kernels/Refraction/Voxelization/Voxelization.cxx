#include "Refraction/Voxelization/Voxelization.h"

#include "Device/Device.h"
#include "Device/Sizes.h"
#include "Refraction/Voxelization/SampleLattice.h"
#include "Refraction/Voxelization/VoxelizationShared.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <optional>
#include <string>

namespace tyndall
{
namespace
{
constexpr std::size_t CrossingGroup = 64; ///< work-items per work-group of the kernels that process crossings
constexpr int SamplesOfWord = 4;          ///< number of samples per word for winding numbers: one byte per sample
/// Maximum number of bytes of the crossings (one byte per sample) that are held at a time to find winding numbers.
constexpr std::size_t WindingBytes = std::size_t(16) << 20;

/// Definitions of macros for Voxelization.cl.
std::string CrossingOptions(int samplesOfVoxel, bool winding)
{
  return Define("SAMPLES", samplesOfVoxel) + Define("WINDING", winding);
}

/// Queues a kernel of Voxelization.cl or SurfaceFraction.cl with one work-item per tile (triangle with a rectangle of
/// sample columns), column or voxel.
void RunCrossings(Device& device, const cl::Kernel& kernel, std::size_t items)
{
  device.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(RoundUp(items, CrossingGroup)), cl::NDRange(CrossingGroup));
}

/// Tiles of a mesh on the device; the buffer is kept between uses. A tile is a triangle with a rectangle of sample
/// columns.
class TilesOnDevice
{
public:
  const Buffer<cl_uint4>& Upload(Device& device, const std::vector<cl_uint4>& tiles)
  {
    if (this->Tiles.Size() < tiles.size())
    {
      this->Tiles = Buffer<cl_uint4>(device, tiles.size() + tiles.size() / 4, "pieces of the mesh");
    }
    this->Tiles.Write(tiles.data(), tiles.size());
    return this->Tiles;
  }

private:
  Buffer<cl_uint4> Tiles;
};

/// Marks in a buffer where meshes cross the columns of samples in some rows (kernel mark_crossings of Voxelization.cl).
class CrossingMarker
{
public:
  /// Compiles the kernel mark_crossings.
  /// @param words      number of 32-bit words per column
  CrossingMarker(Device& device, const SampleColumns& columns, int words, const std::string& options)
    : TheDevice(device)
    , Columns(columns)
    , Words(words)
    , Kernel(device.Kernel("mark_crossings", kernel_source::Voxelization, options))
  {
  }

  /// Queues the kernel for the columns of rows firstRow to endRow.
  /// @param marks  output: `words` 32-bit words for each column of the rows
  /// @param sums   output: for each column, a sum of random numbers by which fill_columns finds samples whose winding
  ///   number is neither 0 nor 1; empty if winding numbers are computed
  void Mark(const LatticeMesh& mesh, int firstRow, int endRow, Buffer<cl_uint>& marks, Buffer<cl_uint>& sums)
  {
    marks.Fill(0);
    sums.Fill(0);
    const std::vector<cl_uint4> tiles = mesh.Tiles(this->Columns, firstRow, endRow);
    if (tiles.empty())
    {
      return;
    }
    With(this->Kernel, static_cast<cl_int>(tiles.size()), this->Tiles.Upload(this->TheDevice, tiles), mesh.Points(),
      mesh.Triangles(), this->Columns.axis, this->Columns.pitch, this->Columns.samples,
      SampleRows{ {}, this->Words, this->Columns.count[0], firstRow, 0, 0 }, marks, sums);
    RunCrossings(this->TheDevice, this->Kernel, tiles.size());
  }

private:
  Device& TheDevice;
  SampleColumns Columns;
  int Words;
  cl::Kernel Kernel;
  TilesOnDevice Tiles;
};

/// Combines the winding numbers of all columns that find_windings (Voxelization.cl) has found.
class WindingSum
{
public:
  WindingSum(const Grid& grid, const VoxelBox& box, const SampleColumns& columns)
    : TheGrid(grid)
    , Box(box)
    , Columns(columns)
  {
  }

  void Add(const cl_int4& ofColumn, int across, int up)
  {
    this->Windings.lowest = std::min(this->Windings.lowest, ofColumn.s[0]);
    this->Windings.highest = std::max(this->Windings.highest, ofColumn.s[1]);
    if (this->Windings.oddSamples == 0 && ofColumn.s[2] > 0)
    {
      std::array<int, 3> sample;
      sample[this->Columns.axis] = ofColumn.s[3];
      sample[this->Columns.across] = across;
      sample[this->Columns.up] = up;
      for (int axis = 0; axis < 3; ++axis)
      {
        const double pitch = this->TheGrid.spacing[axis] / this->Columns.samplesOfVoxel;
        sample[axis] += this->Box.first[axis] * this->Columns.samplesOfVoxel;
        this->Windings.firstOddSample[axis] = this->TheGrid.origin[axis] + (sample[axis] + 0.5) * pitch;
      }
      this->Windings.firstOddNumber = sample;
    }
    this->Windings.oddSamples += static_cast<std::size_t>(ofColumn.s[2]);
  }

  WindingNumbers Windings;

private:
  const Grid& TheGrid;
  const VoxelBox& Box;
  const SampleColumns& Columns;
};

/// Finds the winding numbers of a mesh at the samples in some voxel rows of a box in the grid.
/// @param mesh      mesh on the lattice that starts at the box's first voxel, as do the columns
/// @param rows      flag of each row of voxels along columns.up: nonzero to examine the row
/// @param inverted  whether the corners of triangles run clockwise as seen from outside
WindingNumbers FindWindings(Device& device, const Grid& grid, const VoxelBox& box, const LatticeMesh& mesh,
  const SampleColumns& columns, const std::vector<cl_int>& rows, bool inverted, const Monitor& monitor)
{
  const int words = PartsOf(columns.samples, SamplesOfWord);
  const auto across = static_cast<std::size_t>(columns.count[0]);
  const int atOnce = static_cast<int>(std::clamp<std::size_t>(
    WindingBytes / (across * words * sizeof(cl_uint)), 1, static_cast<std::size_t>(columns.samplesOfVoxel)));
  const std::string options = CrossingOptions(columns.samplesOfVoxel, true);
  CrossingMarker marker(device, columns, words, options);
  cl::Kernel find = device.Kernel("find_windings", kernel_source::Voxelization, options);
  Buffer<cl_uint> marks(device, across * atOnce * words, "crossings of the mesh");
  Buffer<cl_uint> noSums(device, 0, "no sums");
  Buffer<cl_int4> found(device, across * atOnce, "winding numbers");
  std::vector<cl_int4> ofColumns(across * atOnce);

  WindingSum sum(grid, box, columns);
  for (int first = 0; first < columns.count[1]; first += atOnce)
  {
    const int end = std::min(first + atOnce, columns.count[1]);
    const auto from = rows.begin() + first / columns.samplesOfVoxel;
    const auto to = rows.begin() + (end - 1) / columns.samplesOfVoxel + 1;
    if (std::all_of(from, to, [](cl_int asked) { return asked == 0; }))
    {
      continue;
    }
    Report(monitor, static_cast<double>(first) / columns.count[1]);
    const int count = columns.count[0] * (end - first);
    marker.Mark(mesh, first, end, marks, noSums);
    With(find, count, words, columns.samples, inverted ? -1 : 1, marks, found);
    RunCrossings(device, find, Count(count));
    found.Read(ofColumns.data());
    for (int c = 0; c < count; ++c)
    {
      sum.Add(ofColumns[static_cast<std::size_t>(c)], c % columns.count[0], first + c / columns.count[0]);
    }
  }
  return sum.Windings;
}

/// A slab, the part of the grid that is processed at a time: rows of voxels, and the rows of sample columns that they
/// need.
struct SampleSlab
{
  int firstVoxel, endVoxel; ///< range [firstVoxel, endVoxel) of rows of voxels along columns.up
  /// Range of rows of sample columns: those of the voxels and, if counts include fractions of samples, one more on
  /// either side where the grid has one.
  int firstRow, endRow;
};

SampleColumns Along(int axis, const Grid& grid, const SampleColumns& like)
{
  return { grid, axis, like.samplesOfVoxel, like.pitch };
}

/// Refines counts of samples in voxels to a fraction of a sample, from the exact position of the surface between two
/// samples (numerics.md, section 11.1). Whole samples give an occupancy with terraces where a surface is nearly
/// parallel to layers of voxels. The terraces are wider than the filter that smooths the index, and would bend rays.
class SurfaceFraction
{
public:
  /// Compiles the kernels, and allocates the corrections of a slab (the voxels that are processed at a time).
  /// @param columns  columns of the samples' bits, of `words` 32-bit words each
  /// @param voxels   maximum number of voxels in a slab, which take 4 bytes each, and 4 more if there are several
  ///   meshes
  /// @param several  whether there are several meshes
  SurfaceFraction(
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

  /// Prepares the measurement of a slab, the voxels that are processed at a time. Must be called once per slab. The
  /// meshes are measured afterwards, from the last to the first.
  void Begin()
  {
    if (this->Several)
    {
      this->Taken.Fill({});
    }
  }

  /// Queues the measurement of the difference between the volume of a mesh in the slab's voxels and its count of
  /// samples.
  /// @param orientation  1 if the mesh's triangles are counterclockwise as seen from outside, -1 if clockwise, 0 if
  ///   triangles disagree
  /// @param bits         samples inside the mesh, in the slab's rows of samples
  /// @param claimed      samples inside later meshes, in the same rows of samples; empty if there is only one mesh
  void Measure(const LatticeMesh& mesh, int orientation, const SampleSlab& slab, const Buffer<cl_uint>& bits,
    const Buffer<cl_uint>& claimed)
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
      cl::Kernel& kernel = this->MeasureAlong[axis];
      With(kernel, static_cast<cl_int>(tiles.size()), this->Tiles[axis].Upload(this->TheDevice, tiles), mesh.Points(),
        mesh.Triangles(), columns.pitch, columns.samples, this->RowsOf(slab), bits, claimed, this->Taken, orientation,
        this->Corrections);
      RunCrossings(this->TheDevice, kernel, tiles.size());
    }
  }

  /// For the mesh that was measured last: queues the conversion of the slab's counts from whole samples to units of 1 /
  /// UnitsOfSample of a sample, and the addition of the measured difference. Also marks the mesh's samples as claimed
  /// in the rows of samples beside the slab's voxels (SampleSlab), which count_samples does not reach.
  void Refine(const SampleSlab& slab, const Buffer<cl_uint>& bits, Buffer<cl_uint>& claimed, Buffer<cl_ushort>& counts)
  {
    const SampleRows rows = this->RowsOf(slab);
    With(this->RefineCounts, rows, this->Corrections, this->Taken, bits, counts);
    RunCrossings(this->TheDevice, this->RefineCounts, Count(rows.voxels.s[0]) * rows.voxels.s[1] * rows.voxels.s[2]);
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

private:
  void Claim(const SampleSlab& slab, int row, const Buffer<cl_uint>& bits, Buffer<cl_uint>& claimed)
  {
    const int words = this->Bits.count[0] * this->Words;
    With(this->ClaimSamples, static_cast<cl_ulong>(row - slab.firstRow) * words, words, bits, claimed);
    RunCrossings(this->TheDevice, this->ClaimSamples, Count(words));
  }
  SampleRows RowsOf(const SampleSlab& slab) const
  {
    SampleRows rows = { { { this->Size[0], this->Size[1], this->Size[2], 0 } }, this->Words, this->Bits.count[0],
      slab.firstRow, slab.firstVoxel, this->Several };
    rows.voxels.s[this->Bits.up] = slab.endVoxel - slab.firstVoxel;
    return rows;
  }

  Device& TheDevice;
  std::array<int, 3> Size; ///< number of voxels of the grid along each axis
  SampleColumns Bits;      ///< columns of samples in which the bits "inside the mesh" are stored
  int Words;
  bool Several;                         ///< whether there are several meshes
  std::array<SampleColumns, 3> Columns; ///< columns of samples along x, y and z, in which crossings are measured
  std::array<cl::Kernel, 3> MeasureAlong;
  cl::Kernel RefineCounts, ClaimSamples;
  std::array<TilesOnDevice, 3> Tiles;
  /// For each voxel of the slab, the mesh's volume minus its count of samples, in 1 / UNITS of a sample
  /// (SurfaceFraction.cl).
  Buffer<cl_int> Corrections;
  /// Part of each voxel of the slab that later meshes occupy: number of samples (x), and volume in 1 / UnitsOfSample of
  /// a sample (y). Empty if there is only one mesh.
  Buffer<cl_ushort2> Taken;
};

constexpr int LargestSampleCount = 16;
/// Maximum number of voxels in a slab (the voxels that are processed at a time), unless one row of voxels has more.
constexpr std::size_t SlabVoxels = std::size_t(4) << 20;

/// Number of 32-bit words in a column of samples along an axis.
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

/// Number of rows of voxels in a slab whose columns of samples take about `bytes` bytes.
int RowsOfSlab(const SampleColumns& columns, const Grid& grid, int words, std::size_t bytes)
{
  const std::size_t row = static_cast<std::size_t>(columns.count[0]) * columns.samplesOfVoxel * words * sizeof(cl_uint);
  const std::size_t rows = std::min(bytes / row, SlabVoxels / VoxelsOfRow(columns, grid));
  return static_cast<int>(std::clamp<std::size_t>(rows, 1, static_cast<std::size_t>(grid.size[columns.up])));
}

/// For each voxel of a box, counts the samples inside each of several meshes, slab by slab: a slab is the set of voxel
/// rows whose samples are held at a time.
class Voxelization
{
public:
  Voxelization(Device& device, const Grid& grid, const CountedVoxels& counted, const std::vector<OrientedMesh>& meshes,
    const VoxelizationSettings& settings)
    : TheDevice(device)
    , Whole(grid)
    , Counted(counted)
    , TheGrid(GridOfBox(counted.box, grid))
    , Lattice(grid, settings.samples, TrianglesOf(meshes))
    , Columns(TheGrid, settings.columnAxis, settings.samples, this->Lattice.Pitch())
    , Words(WordsOf(TheGrid, settings.columnAxis, 32 / settings.samples))
    , Rows(RowsOfSlab(this->Columns, TheGrid, this->Words, settings.slabBytes))
    , Marker(device, this->Columns, this->Words, CrossingOptions(settings.samples, false))
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
    const auto columns = static_cast<std::size_t>(this->Columns.count[0]) *
      (this->Rows * this->Columns.samplesOfVoxel + 2 * RowsAround(settings));
    this->Bits = Buffer<cl_uint>(device, columns * this->Words, "a slab of the fine grid");
    this->Sums = Buffer<cl_uint>(device, columns, "sums of crossings");
    // With a single mesh no samples are claimed, and the kernel receives an empty buffer.
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
  /// Number of rows of sample columns that a slab (the voxels that are processed at a time) needs beyond each of its
  /// two sides.
  static int RowsAround(const VoxelizationSettings& settings) { return settings.fractions ? 1 : 0; }

  /// Winding numbers of a mesh at the samples of the voxels Counted.own.
  /// @param rows  flag of each row of these voxels: nonzero if it may have odd samples, whose winding number is neither
  ///   0 nor 1
  WindingNumbers WindingsOf(const OrientedMesh& mesh, const std::vector<cl_int>& rows, const Monitor& monitor) const
  {
    const VoxelBox& own = this->Counted.own;
    if (own.VoxelCount() == 0 || std::all_of(rows.begin(), rows.end(), [](cl_int row) { return row == 0; }))
    {
      return {};
    }
    const LatticeMesh onLattice(this->TheDevice, this->Lattice.From(own.first), *mesh.mesh);
    const SampleColumns columns(
      GridOfBox(own, this->Whole), this->Columns.axis, this->Columns.samplesOfVoxel, this->Columns.pitch);
    return FindWindings(this->TheDevice, this->Whole, own, onLattice, columns, rows, mesh.orientation < 0, monitor);
  }

  SampleSlab RowsOf(int first, int end) const
  {
    const int around = this->Fractions ? 1 : 0;
    return { first, end, std::max(first * this->Columns.samplesOfVoxel - around, 0),
      std::min(end * this->Columns.samplesOfVoxel + around, this->Columns.count[1]) };
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
      With(this->Fill, columns, this->Columns.count[0], this->Words, this->Bits, this->Sums,
        this->Oriented[m].orientation, this->Odd, firstOdd, slab.firstRow);
      RunCrossings(this->TheDevice, this->Fill, static_cast<std::size_t>(columns));
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
    const int skipped = slab.firstVoxel * this->Columns.samplesOfVoxel - slab.firstRow;
    const int units = this->Fractions ? 1 : UnitsOfSample(this->Columns.samplesOfVoxel);
    const std::array<int, 3>& size = this->TheGrid.size;
    const std::array<int, 3> stride = { 1, size[0], size[0] * (this->Columns.up == 1 ? rows : size[1]) };
    const int columns = size[this->Columns.across];
    const SampleCounts how = { size[this->Columns.axis], columns, rows, this->Words, skipped, this->Claimed.Size() > 0,
      units, stride[this->Columns.axis], stride[this->Columns.across], stride[this->Columns.up] };
    With(this->Count, how, this->Bits, this->Claimed, this->Counts);
    this->TheDevice.Queue().enqueueNDRangeKernel(this->Count, cl::NullRange,
      cl::NDRange(RoundUp(static_cast<std::size_t>(columns), CrossingGroup), static_cast<std::size_t>(rows)),
      cl::NDRange(CrossingGroup, 1));
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
  const Grid TheGrid; ///< the box whose samples are counted, as a grid
  SampleLattice Lattice;
  SampleColumns Columns;
  int Words; ///< number of 32-bit words per column of samples
  int Rows;  ///< number of rows of voxels that are processed at a time (a slab)
  CrossingMarker Marker;
  cl::Kernel Fill, Count;
  std::vector<OrientedMesh> Oriented;
  std::vector<LatticeMesh> Meshes;
  Buffer<cl_uint> Bits, Sums, Claimed;
  Buffer<cl_ushort> Counts;
  std::optional<SurfaceFraction> Fractions; ///< no value if the settings request no fractions of samples
  /// For each mesh, a flag per row of voxels: nonzero where FindWindings has to look for samples whose winding number
  /// is neither 0 nor 1.
  Buffer<cl_int> Odd;
};
}

void WindingNumbers::Add(const WindingNumbers& others)
{
  const auto place = [](const std::array<int, 3>& number) {
    return std::array<int, 3>{ number[2], number[1], number[0] };
  };
  const bool first = this->oddSamples == 0 || place(others.firstOddNumber) < place(this->firstOddNumber);
  if (others.oddSamples > 0 && first)
  {
    this->firstOddSample = others.firstOddSample;
    this->firstOddNumber = others.firstOddNumber;
  }
  this->oddSamples += others.oddSamples;
  this->lowest = std::min(this->lowest, others.lowest);
  this->highest = std::max(this->highest, others.highest);
}

void Check(const VoxelizationSettings& settings)
{
  Require(settings.samples >= 1 && settings.samples <= LargestSampleCount,
    "The supersampling factor is " + std::to_string(settings.samples) + "; it must be 1 to " +
      std::to_string(LargestSampleCount) + ".");
  Require(settings.columnAxis >= 0 && settings.columnAxis <= 2,
    "Columns run along axis 0, 1 or 2, not " + std::to_string(settings.columnAxis) + ".");
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
}
