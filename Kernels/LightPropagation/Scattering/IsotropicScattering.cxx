#include "LightPropagation/Scattering/IsotropicScattering.h"

#include "Device/Device.h"
#include "Device/Sizes.h"
#include "LightPropagation/Scattering/CollectShared.h"
#include "Numerics/Constants.h"
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
  const int vector = this->TheDevice.KernelWidth(4, 8, 4);
  return this->TheDevice.Kernel(name, kernel_source::IsotropicScattering,
    Define("REAL_WIDTH", vector) + Define("SCATTERS", this->Scatters) + SummingOption(this->TheDevice) +
      ExactOption(this->TheDevice));
}

ScatteringOperator::Powers IsotropicScattering::ScatterOrder(const Deposit& swept, const Buffer<float>& fluence,
  const Buffer<float>& source, const std::array<std::size_t, 2>& range) const
{
  cl::Kernel kernel = this->Kernel("scatter_order");
  const auto [begin, end] = range;
  const std::size_t chunks = PartsOf<std::size_t>(end - begin, CollectChunk);
  const int channels = this->Layout.channels;
  Buffer<cl_float2> tally(this->TheDevice, chunks * channels, "sums");
  With(kernel, *swept.path, fluence, source, this->TheMedium.SigmaT(), this->TheMedium.SigmaS(), tally,
    cl_ulong(this->Layout.Stride()), cl_ulong(begin), cl_ulong(end), cl_int(this->Layout.sharedExtinction),
    this->PerVolume());
  RunSummingGroups(this->TheDevice, kernel, chunks, channels);
  Powers powers;
  const std::vector<cl_float2> sums = tally.Read();
  for (std::size_t i = 0; i < sums.size(); ++i)
  {
    powers.absorbed[i / chunks] += sums[i].s[0];
    powers.scattered[i / chunks] += sums[i].s[1];
  }
  return powers;
}

void IsotropicScattering::ScatterAllOrders(const Buffer<float>& fluence, const Buffer<float>& source) const
{
  cl::Kernel kernel = this->Kernel("scatter_all_orders");
  With(kernel, fluence, source, this->TheMedium.SigmaS(), cl_ulong(this->Layout.Stride()));
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, this->Values());
}

void IsotropicScattering::AddFirstScattered(const Deposit& uncollided, const Buffer<float>& source) const
{
  cl::Kernel kernel = this->Kernel("add_first_scattered");
  With(kernel, *uncollided.path, source, this->TheMedium.SigmaS(), cl_ulong(this->Layout.Stride()));
  SetExact(this->TheDevice, kernel, 4, 4.0 * Pi * this->Layout.grid.VoxelVolume());
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, this->Values());
}

void IsotropicScattering::ScatterFluence(int channel, const Deposit&, const ExactValues& fluence,
  const Buffer<float>& given, const Buffer<float>& source) const
{
  cl::Kernel kernel = this->Kernel("scatter_fluence");
  With(kernel, fluence.Handle(), given, source, this->TheMedium.SigmaS(), cl_ulong(channel * this->Layout.Stride()));
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(this->Layout.grid.VoxelCount()));
}
}
