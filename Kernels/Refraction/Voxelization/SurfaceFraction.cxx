#include "Refraction/Voxelization/SurfaceFraction.h"

#include "Device/Defines.h"
#include "Refraction/Voxelization/CrossingMarker.h"
#include "TyndallKernelSources.h"

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
}
