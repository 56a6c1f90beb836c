#include "Refraction/Voxelization/WindingNumbers.h"

#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <vector>

namespace tyndall
{
std::string CrossingOptions(int samplesOfVoxel, bool winding)
{
  return Define("SAMPLES", samplesOfVoxel) + Define("WINDING", winding);
}

cl::NDRange CrossingRange(std::size_t items)
{
  return cl::NDRange(RoundUp(items, CrossingGroup().get()[0]));
}

CrossingMarker::CrossingMarker(
  Device& device, const SampleColumns& columns, int words, bool fromAbove, const std::string& options)
  : TheDevice(device)
  , Columns(columns)
  , Words(words)
  , FromAbove(fromAbove)
  , Kernel(device.Kernel("mark_crossings", kernel_source::Voxelization, options))
{
}

void CrossingMarker::Mark(
  const LatticeMesh& mesh, int firstRow, int endRow, Buffer<cl_uint>& marks, Buffer<cl_uint>& sums)
{
  marks.Fill(0);
  sums.Fill(0);
  const std::vector<cl_uint4> tiles = mesh.Tiles(this->Columns, firstRow, endRow);
  if (tiles.empty())
  {
    return;
  }
  if (this->Tiles.Size() < tiles.size())
  {
    this->Tiles = Buffer<cl_uint4>(this->TheDevice, tiles.size() + tiles.size() / 4, "pieces of the mesh");
  }
  this->Tiles.Write(tiles.data(), tiles.size());
  With(this->Kernel, static_cast<cl_int>(tiles.size()), this->Tiles, mesh.Points(), mesh.Triangles(),
    this->Columns.axis, this->Columns.pitch, this->Columns.samples, static_cast<cl_int>(this->FromAbove),
    this->Columns.count[0], this->Words, firstRow, marks, sums);
  this->TheDevice.Queue().enqueueNDRangeKernel(
    this->Kernel, cl::NullRange, CrossingRange(tiles.size()), CrossingGroup());
}

namespace
{
constexpr int SamplesOfWord = 4; ///< one byte per sample
constexpr std::size_t SlabBytes = std::size_t(16) << 20;

/// Combines the results of find_windings (Voxelization.cl) for all columns.
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

WindingNumbers FindWindings(Device& device, const Grid& grid, const VoxelBox& box, const LatticeMesh& mesh,
  const SampleColumns& columns, const std::vector<cl_int>& rows, bool inverted, const Monitor& monitor)
{
  const int words = PartsOf(columns.samples, SamplesOfWord);
  const auto across = static_cast<std::size_t>(columns.count[0]);
  const int atOnce = static_cast<int>(std::clamp<std::size_t>(
    SlabBytes / (across * words * sizeof(cl_uint)), 1, static_cast<std::size_t>(columns.samplesOfVoxel)));
  const std::string options = CrossingOptions(columns.samplesOfVoxel, true);
  CrossingMarker marker(device, columns, words, false, options);
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
    device.Queue().enqueueNDRangeKernel(
      find, cl::NullRange, CrossingRange(static_cast<std::size_t>(count)), CrossingGroup());
    found.Read(ofColumns.data());
    for (int c = 0; c < count; ++c)
    {
      sum.Add(ofColumns[static_cast<std::size_t>(c)], c % columns.count[0], first + c / columns.count[0]);
    }
  }
  return sum.Windings;
}
}
