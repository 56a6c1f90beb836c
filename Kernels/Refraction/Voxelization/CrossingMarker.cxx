#include "Refraction/Voxelization/CrossingMarker.h"

#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "TyndallKernelSources.h"

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
}
