#include "LightPropagation/Conservative/IsotropicScattering.h"

#include "Device/Defines.h"
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

IsotropicScattering::Powers IsotropicScattering::Scatter(const Buffer<float>& path, const Buffer<float>& fluence,
  const Buffer<float>& source, const std::array<std::size_t, 2>& range) const
{
  const int vector = this->TheDevice.FloatVectorWidth() >= 8 ? 8 : 4;
  cl::Kernel kernel =
    this->TheDevice.Kernel("collect", { kernel_source::Numerics, kernel_source::IsotropicScattering },
      Define("REAL_WIDTH", vector) + Define("SCATTERS", this->Scatters));
  const auto [begin, end] = range;
  const std::size_t chunks = (end - begin + CollectChunk - 1) / CollectChunk;
  const int channels = this->Layout.channels;
  Buffer<cl_float2> tally(this->TheDevice, chunks * channels, "sums");
  With(kernel, path, fluence, source, this->TheMedium.SigmaT(), this->TheMedium.SigmaS(), tally,
    cl_ulong(this->Layout.Stride()), cl_ulong(begin), cl_ulong(end), cl_int(this->Layout.sharedExtinction),
    static_cast<float>(1.0 / this->Layout.grid.VoxelVolume()));
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(chunks, channels), cl::NDRange(1, 1));
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
  cl::Kernel kernel =
    this->TheDevice.Kernel("gather_scattered", { kernel_source::Numerics, kernel_source::IsotropicScattering });
  With(kernel, fluence, source, this->TheMedium.SigmaS(), cl_ulong(this->Layout.Stride()));
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(this->Layout.Stride(), this->Layout.channels));
}
}
