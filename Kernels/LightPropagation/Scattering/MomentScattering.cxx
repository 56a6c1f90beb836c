#include "LightPropagation/Scattering/MomentScattering.h"

#include "Device/Device.h"
#include "Numerics/Constants.h"
#include "TyndallKernelSources.h"

#include <stdexcept>

namespace tyndall
{
MomentScattering::MomentScattering(Device& device, const VolumeLayout& layout, const MediumOnDevice& medium, int degree)
  : TheDevice(device)
  , Layout(layout)
  , TheMedium(medium)
  , OfFluence(device, layout, medium, true)
  , Degree(degree)
  , Functions((degree + 1) * (degree + 1))
{
}

/// Runs a kernel of MomentScattering.cl on a channel's moments except the first, one work-item per row of voxels.
/// @param arguments  kernel arguments after the layout of the moments and the channel
template <class... Arguments>
void MomentScattering::RunOnMoments(const char* name, int channel, const Arguments&... arguments) const
{
  cl::Kernel kernel = this->TheDevice.Kernel(name, kernel_source::MomentScattering);
  With(kernel, this->Layout.Places(this->Functions), cl_int(channel), arguments...);
  const std::array<int, 3>& size = this->Layout.grid.size;
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange,
    cl::NDRange(static_cast<std::size_t>(size[1]) * size[2]), GroupOfLargeItems(this->TheDevice));
}

/// Factor from path integral, W length, to source, W / (length^3 sr), for a scattering coefficient of 1.
float MomentScattering::PerPath() const
{
  return static_cast<float>(1.0 / (4.0 * Pi * this->Layout.grid.VoxelVolume()));
}

ScatteringOperator::Powers MomentScattering::ScatterOrder(const Deposit& swept, const Buffer<float>& fluence,
  const Buffer<float>& source, const std::array<std::size_t, 2>& range) const
{
  const Powers powers = this->OfFluence.ScatterOrder(swept, fluence, source, range);
  if (swept.flux)
  {
    AddFluxOfMoments(this->TheDevice, this->Layout, this->Functions, *swept.path, *swept.flux);
  }
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    this->RunOnMoments("scatter_moments", c, *swept.path, source, this->TheMedium.SigmaOfDegrees(),
      cl_ulong(this->Layout.Stride()), this->PerPath());
  }
  return powers;
}

void MomentScattering::ScatterAllOrders(const Buffer<float>&, const Buffer<float>&) const
{
  throw std::logic_error("the moments of all orders are not kept");
}

void MomentScattering::AddFirstScattered(const Deposit& uncollided, const Buffer<float>& source) const
{
  this->OfFluence.AddFirstScattered(uncollided, source);
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    this->RunOnMoments("add_scattered_moments", c, *uncollided.path, source, this->TheMedium.SigmaOfDegrees(),
      cl_ulong(this->Layout.Stride()), this->PerPath());
  }
}

void MomentScattering::AddBeam(const Buffer<float>& path, const Buffer<float>& source, int beam) const
{
  const std::size_t values = this->Layout.channels * this->Layout.Stride();
  cl::Kernel kernel = this->TheDevice.Kernel("scatter_beam", kernel_source::MomentScattering);
  With(kernel, this->Layout.Places(this->Functions), path, source, this->TheMedium.SigmaOfDegrees(), cl_ulong(values),
    cl_int(beam), cl_int(this->Degree), this->PerPath());
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(values));
  this->TheDevice.Finish(); // the caller releases `path`
}

void MomentScattering::ScatterFluence(int channel, const Deposit& swept, const ExactValues& fluence,
  const Buffer<float>& given, const Buffer<float>& source) const
{
  this->OfFluence.ScatterFluence(channel, swept, fluence, given, source);
  this->RunOnMoments("scatter_given_moments", channel, *swept.path, given, source, this->TheMedium.SigmaOfDegrees(),
    cl_ulong(this->Layout.Stride()), this->PerPath());
}

std::unique_ptr<const ScatteringOperator> MakeScattering(
  Device& device, const VolumeLayout& layout, const MediumOnDevice& medium, int degree, bool scatters)
{
  if (degree > 0)
  {
    return std::make_unique<MomentScattering>(device, layout, medium, degree);
  }
  return std::make_unique<IsotropicScattering>(device, layout, medium, scatters);
}

void AddMoments(
  Device& device, const VolumeLayout& layout, int functions, const Buffer<float>& path, const Buffer<float>& to)
{
  const MomentPlaces places = layout.Places(functions);
  cl::Kernel kernel = device.Kernel("add_moments", kernel_source::MomentScattering);
  With(kernel, places, path, to);
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(places.beams - places.second));
}

void AddToShown(Device& device, std::size_t values, const Buffer<float>& source, const Buffer<float>& shown, float part)
{
  cl::Kernel kernel = device.Kernel("add_to_shown", kernel_source::MomentScattering);
  With(kernel, source, shown, part);
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(values));
}

void AddFluxOfMoments(
  Device& device, const VolumeLayout& layout, int functions, const Buffer<float>& path, const Buffer<float>& flux)
{
  const std::array<int, 3>& size = layout.grid.size;
  for (int c = 0; c < layout.channels; ++c)
  {
    cl::Kernel kernel = device.Kernel("add_flux_of_moments", kernel_source::MomentScattering);
    With(kernel, layout.Places(functions), cl_int(c), path, flux, cl_ulong(layout.Stride()));
    device.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(size[0], static_cast<std::size_t>(size[1]) * size[2]));
  }
}
}
