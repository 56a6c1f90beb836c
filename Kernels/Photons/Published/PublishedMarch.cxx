#include "Photons/Published/PublishedMarch.h"

#include "Device/Defines.h"
#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr std::size_t PhotonsPerLaunch = 1 << 16;

int Components(const Field& field)
{
  return field.values ? field.components : 0;
}

IndexGrid IndexSizeOf(const std::array<int, 3>& size)
{
  return { { size[0], size[1], size[2] } };
}

cl::NDRange RangeOf(const std::array<int, 3>& size)
{
  return { static_cast<std::size_t>(size[0]), static_cast<std::size_t>(size[1]), static_cast<std::size_t>(size[2]) };
}
}

PublishedMarch::PublishedMarch(Device& device, const Medium& medium, const float* ior, const std::uint8_t* levels,
  const MarchedPart& part, int stepLimit, int tries)
  : TheDevice(device)
  , TheMedium(medium)
  , Voxels(medium.grid.VoxelCount())
  , Options(Define("BENDS", ior != nullptr) + Define("LEVELS", levels != nullptr) + Define("TRIES", tries) +
      Define("A_CHANNELS", Components(medium.sigma_a)) + Define("S_CHANNELS", Components(medium.sigma_s)))
  , Info(this->Describe(part, stepLimit))
  , Index(this->FindIndex(ior, part))
  , SigmaA(this->Upload(medium.sigma_a))
  , SigmaS(this->Upload(medium.sigma_s))
  , Nodes(levels ? Buffer<cl_uchar>(device, levels, this->Voxels, "octree levels")
                 : Buffer<cl_uchar>(device, 0, "octree levels"))
  , Packed(device, this->Voxels, "packed light")
{
  this->Packed.Fill(0);
  device.Finish();
}

void PublishedMarch::March(std::vector<PublishedPhoton>& photons, const Monitor& monitor)
{
  cl::Kernel march = this->Kernel("march_published");
  for (std::size_t first = 0; first < photons.size(); first += PhotonsPerLaunch)
  {
    const std::size_t count = std::min(PhotonsPerLaunch, photons.size() - first);
    const Buffer<PublishedPhoton> some(this->TheDevice, photons.data() + first, count, "photons");
    With(march, this->Info, this->Index, this->SigmaA, this->SigmaS, this->Nodes, some, this->Packed);
    this->Launch(march, cl::NDRange(count));
    some.Read(photons.data() + first, count);
    Report(monitor, static_cast<double>(first + count) / static_cast<double>(photons.size()));
  }
}

PublishedMarch::Light PublishedMarch::Unpack(double unit)
{
  const double volume = this->TheMedium.grid.VoxelVolume();
  const Buffer<float> fluence(this->TheDevice, 3 * this->Voxels, "fluence");
  const Buffer<float> direction(this->TheDevice, 3 * this->Voxels, "mean direction");
  cl::Kernel unpack = this->Kernel("unpack_light");
  With(unpack, static_cast<float>(unit * std::cbrt(volume) / volume), this->Packed, fluence, direction);
  this->Launch(unpack, cl::NDRange(this->Voxels));
  return { fluence.Read(), direction.Read() };
}

PublishedMarchInfo PublishedMarch::Describe(const MarchedPart& part, int stepLimit) const
{
  PublishedMarchInfo info = {};
  info.whole = IndexSizeOf(part.whole.size);
  info.own = IndexSizeOf(part.own.size);
  info.known = IndexSizeOf(part.known.size);
  for (int a = 0; a < 3; ++a)
  {
    info.first[a] = part.own.first[a];
    info.knownFirst[a] = part.known.first[a];
    info.spacing[a] = static_cast<float>(part.whole.spacing[a]);
  }
  info.stepLimit = stepLimit;
  return info;
}

cl::Kernel PublishedMarch::Kernel(const char* name)
{
  return this->TheDevice.Kernel(name, kernel_source::PublishedPhotons, this->Options);
}

void PublishedMarch::Launch(const cl::Kernel& kernel, const cl::NDRange& range)
{
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, range, cl::NullRange);
}

Buffer<float> PublishedMarch::Upload(const Field& field)
{
  const std::size_t count = this->Voxels * static_cast<std::size_t>(Components(field));
  return count > 0 ? Buffer<float>(this->TheDevice, field.values, count, "a coefficient")
                   : Buffer<float>(this->TheDevice, 0, "a coefficient");
}

Buffer<cl_float4> PublishedMarch::FindIndex(const float* ior, const MarchedPart& part)
{
  const std::size_t known = ior ? part.known.VoxelCount() : 0;
  Buffer<cl_float4> index(this->TheDevice, known, "index and gradient");
  if (known > 0)
  {
    const Buffer<float> n(this->TheDevice, ior, known, "ior");
    cl::Kernel kernel = this->Kernel("published_index");
    With(kernel, this->Info, n, index);
    this->Launch(kernel, RangeOf(part.known.size));
    this->TheDevice.Finish(); // before n is released
  }
  return index;
}

std::vector<float> PublishedMarch::Smoothed(const VoxelBox& box, const std::vector<float>& values)
{
  Buffer<float> from(this->TheDevice, values, "light"), to(this->TheDevice, values.size(), "smoothed light");
  cl::Kernel kernel = this->Kernel("smooth_along");
  for (int axis = 0; axis < 3; ++axis)
  {
    With(kernel, cl_int(axis), IndexSizeOf(box.size), from, to);
    this->Launch(kernel, RangeOf(box.size));
    from.Swap(to);
  }
  return from.Read();
}
}
