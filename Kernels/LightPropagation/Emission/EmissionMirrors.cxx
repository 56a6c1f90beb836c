#include "LightPropagation/Emission/EmissionRays.h"

#include "LightPropagation/Emission/EmissionFans.h"
#include "TyndallKernelSources.h"

#include <array>
#include <cstddef>

namespace tyndall
{
namespace
{
/// Whether one channel of the emission in a box of `size` voxels, x fastest, is symmetric across an axis.
bool IsMirrored(const float* emission, const int* size, int axis)
{
  const std::array<std::ptrdiff_t, 3> strides = { 1, size[0], static_cast<std::ptrdiff_t>(size[0]) * size[1] };
  for (int z = 0; z < size[2]; ++z)
  {
    for (int y = 0; y < size[1]; ++y)
    {
      for (int x = 0; x < size[0]; ++x)
      {
        const std::array<int, 3> at = { x, y, z };
        const std::ptrdiff_t here = x + y * strides[1] + z * strides[2];
        if (emission[here] != emission[here + (size[axis] - 1 - 2 * at[axis]) * strides[axis]])
        {
          return false;
        }
      }
    }
  }
  return true;
}
}

EmissionMirrors::EmissionMirrors(
  Device& device, const SweepVolume& volume, const EmissionInfo& info, const std::vector<float>& emission)
  : TheDevice(device)
  , Volume(volume)
  , Info(info)
{
  this->FindMirrored(emission);
}

void EmissionMirrors::FindMirrored(const std::vector<float>& emission)
{
  const std::size_t voxels = emission.size() / this->Volume.channels;
  int mirrored = 0;
  for (int axis = 0; axis < 3; ++axis)
  {
    bool same = 2 * this->Info.sourceFirst[axis] + this->Info.sourceSize[axis] == this->Info.size[axis];
    for (int c = 0; c < this->Volume.channels; ++c)
    {
      same = same && IsMirrored(emission.data() + c * voxels, this->Info.sourceSize, axis);
    }
    mirrored |= same ? 1 << axis : 0;
  }
  if (mirrored == 0)
  {
    return;
  }
  Buffer<float> differs(this->TheDevice, 3, "mirror images");
  differs.Fill(0.0f);
  cl::Kernel find = this->TheDevice.Kernel("find_mirrors", kernel_source::EmissionMirrors);
  With(find, this->Info, cl_int(mirrored), *this->Volume.sigma_t, cl_ulong(this->Volume.sigma_t_first), differs);
  this->TheDevice.Queue().enqueueNDRangeKernel(
    find, cl::NullRange, cl::NDRange(this->Info.size[1], this->Info.size[2]));
  const std::vector<float> found = differs.Read();
  for (int axis = 0; axis < 3; ++axis)
  {
    mirrored &= found[axis] > 0.0f ? ~(1 << axis) : ~0;
  }
  this->Mirrored = mirrored;
}

void EmissionMirrors::MarkImages(const Buffer<float>& voxels, const Buffer<float>& cells) const
{
  if (this->Mirrored == 0)
  {
    return;
  }
  cl::Kernel mark = this->TheDevice.Kernel("mark_images", kernel_source::EmissionMirrors);
  With(mark, this->Info, cl_int(this->Mirrored), voxels);
  const int* n = this->Info.size;
  this->TheDevice.Queue().enqueueNDRangeKernel(mark, cl::NullRange, cl::NDRange(n[0], n[1], n[2]));
  for (int face = 0; face < 6; ++face)
  {
    const int axis = face / 2;
    cl::Kernel markCells = this->TheDevice.Kernel("mark_image_cells", kernel_source::EmissionMirrors);
    With(markCells, this->Info, cl_int(this->Mirrored), cl_int(face), cl_ulong(FanFaceFirst(this->Volume.grid, face)),
      cells);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      markCells, cl::NullRange, cl::NDRange(n[(axis + 1) % 3], n[(axis + 2) % 3]));
  }
}

void EmissionMirrors::CopyVoxels(const Buffer<float>& path, const Buffer<float>& flux) const
{
  if (this->Mirrored == 0)
  {
    return;
  }
  const int* n = this->Info.size;
  const bool hasFlux = flux.Size() > 0;
  cl::Kernel copy = this->TheDevice.Kernel("copy_images", kernel_source::EmissionMirrors);
  With(copy, this->Info, cl_int(this->Mirrored), cl_int(this->Volume.channels), cl_ulong(this->Volume.stride), path,
    hasFlux ? flux : path, cl_int(hasFlux));
  this->TheDevice.Queue().enqueueNDRangeKernel(copy, cl::NullRange, cl::NDRange(n[0], n[1], n[2]));
}

void EmissionMirrors::CopyCells(const Buffer<float>& faces) const
{
  for (int face = 0; face < 6 && this->Mirrored != 0; ++face)
  {
    // The high face of a mirrored axis is the image of the low one, whose cells come first.
    const int axis = face / 2, from = (this->Mirrored >> axis & 1) != 0 ? face & ~1 : face;
    const int* n = this->Info.size;
    cl::Kernel copy = this->TheDevice.Kernel("copy_image_cells", kernel_source::EmissionMirrors);
    With(copy, this->Info, cl_int(this->Mirrored), cl_int(face), cl_ulong(FanFaceFirst(this->Volume.grid, from)),
      cl_ulong(FanFaceFirst(this->Volume.grid, face)), cl_int(this->Volume.channels), faces);
    this->TheDevice.Queue().enqueueNDRangeKernel(
      copy, cl::NullRange, cl::NDRange(n[(axis + 1) % 3], n[(axis + 2) % 3]));
  }
}
}
