#include "LightPropagation/Conservative/IsotropicScattering.h"

#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "LightPropagation/Conservative/CollectShared.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
IsotropicScattering::IsotropicScattering(
  Device& device, const VolumeLayout& layout, const MediumOnDevice& medium, bool scatters)
  : TheDevice(device)
  , Layout(layout)
  , TheMedium(medium)
  , Scatters(scatters)
{
}

cl::Kernel IsotropicScattering::Kernel(const char* name) const
{
  const int vector = this->TheDevice.FloatVectorWidth() >= 8 ? 8 : 4;
  return this->TheDevice.Kernel(
    name, kernel_source::IsotropicScattering, Define("REAL_WIDTH", vector) + Define("SCATTERS", this->Scatters));
}

IsotropicScattering::Powers IsotropicScattering::Scatter(const Buffer<float>& path, const Buffer<float>& fluence,
  const Buffer<float>& source, const std::array<std::size_t, 2>& range) const
{
  cl::Kernel kernel = this->Kernel("collect");
  const auto [begin, end] = range;
  const std::size_t chunks = PartsOf<std::size_t>(end - begin, CollectChunk);
  const int channels = this->Layout.channels;
  Buffer<cl_float2> tally(this->TheDevice, chunks * channels, "sums");
  With(kernel, path, fluence, source, this->TheMedium.SigmaT(), this->TheMedium.SigmaS(), tally,
    cl_ulong(this->Layout.Stride()), cl_ulong(begin), cl_ulong(end), cl_int(this->Layout.sharedExtinction),
    static_cast<float>(1.0 / this->Layout.grid.VoxelVolume()));
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(chunks, channels), cl::NDRange(1, 1));
  Powers powers;
  const std::vector<cl_float2> sums = tally.Read();
  for (std::size_t i = 0; i < sums.size(); ++i)
  {
    powers.absorbed[i / chunks] += sums[i].s[0];
    powers.scattered[i / chunks] += sums[i].s[1];
  }
  return powers;
}

void IsotropicScattering::SourceOfAll(const Buffer<float>& fluence, const Buffer<float>& source) const
{
  cl::Kernel kernel = this->Kernel("gather_scattered");
  With(kernel, fluence, source, this->TheMedium.SigmaS(), cl_ulong(this->Layout.Stride()));
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(this->Layout.Stride(), this->Layout.channels));
}

void IsotropicScattering::AddOutside(const VoxelBox& box, const Buffer<float>& path, const Buffer<float>& fluence) const
{
  cl::Kernel add = this->Kernel("add_outside");
  const std::array<int, 3>& n = this->Layout.grid.size;
  With(add, path, fluence, cl_ulong(this->Layout.Stride()), static_cast<float>(1.0 / this->Layout.grid.VoxelVolume()),
    cl_int3{ { n[0], n[1], n[2] } }, cl_int3{ { box.first[0], box.first[1], box.first[2] } },
    cl_int3{ { box.size[0], box.size[1], box.size[2] } });
  this->TheDevice.Queue().enqueueNDRangeKernel(
    add, cl::NullRange, cl::NDRange(this->Layout.Stride(), this->Layout.channels));
}
}
