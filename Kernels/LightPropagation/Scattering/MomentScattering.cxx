#include "LightPropagation/Scattering/MomentScattering.h"

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
  , Functions(static_cast<std::size_t>(degree + 1) * (degree + 1))
{
}

cl::Kernel MomentScattering::Kernel(const char* name) const
{
  return this->TheDevice.Kernel(name, kernel_source::MomentScattering);
}

/// From a path integral, W length, to the source of what is scattered of it with a coefficient of 1.
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
    AddFluxOfMoments(this->TheDevice, this->Layout, *swept.path, *swept.flux);
  }
  cl::Kernel kernel = this->Kernel("scatter_moments");
  With(
    kernel, *swept.path, source, this->TheMedium.SigmaOfDegrees(), cl_ulong(this->FunctionStride()), this->PerPath());
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, this->Moments(this->FunctionStride()));
  return powers;
}

void MomentScattering::ScatterAllOrders(const Buffer<float>&, const Buffer<float>&) const
{
  throw std::logic_error("the moments of all orders are not kept");
}

void MomentScattering::AddFirstScattered(const Deposit& uncollided, const Buffer<float>& source) const
{
  this->OfFluence.AddFirstScattered(uncollided, source);
  cl::Kernel kernel = this->Kernel("add_scattered_moments");
  With(kernel, *uncollided.path, source, this->TheMedium.SigmaOfDegrees(), cl_ulong(this->FunctionStride()),
    this->PerPath());
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, this->Moments(this->FunctionStride()));
}

void MomentScattering::AddBeam(const Buffer<float>& path, const Buffer<float>& source, int slot) const
{
  cl::Kernel kernel = this->Kernel("scatter_beam");
  With(kernel, path, source, this->TheMedium.SigmaOfDegrees(), cl_ulong(this->FunctionStride()), cl_int(slot),
    cl_int(this->Degree), this->PerPath());
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(this->FunctionStride()));
  this->TheDevice.Finish(); // the path goes
}

void MomentScattering::ScatterFluence(int channel, const Deposit& swept, const ExactValues& fluence,
  const Buffer<float>& given, const Buffer<float>& source) const
{
  this->OfFluence.ScatterFluence(channel, swept, fluence, given, source);
  cl::Kernel kernel = this->Kernel("scatter_given_moments");
  With(kernel, *swept.path, given, source, this->TheMedium.SigmaOfDegrees(), cl_ulong(this->FunctionStride()),
    cl_ulong(channel * this->Layout.Stride()), this->PerPath());
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, this->Moments(this->Layout.grid.VoxelCount()));
}

void AddMoments(Device& device, std::size_t stride, int functions, const Buffer<float>& path, const Buffer<float>& to)
{
  cl::Kernel kernel = device.Kernel("add_moments", kernel_source::MomentScattering);
  With(kernel, path, to, cl_ulong(stride));
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(stride, functions - 1));
}

void AddToShown(Device& device, std::size_t values, const Buffer<float>& source, const Buffer<float>& shown, float part)
{
  cl::Kernel kernel = device.Kernel("add_to_shown", kernel_source::MomentScattering);
  With(kernel, source, shown, part);
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(values));
}

void AddFluxOfMoments(Device& device, const VolumeLayout& layout, const Buffer<float>& path, const Buffer<float>& flux)
{
  cl::Kernel kernel = device.Kernel("add_flux_of_moments", kernel_source::MomentScattering);
  With(kernel, path, flux, cl_ulong(layout.Stride()), cl_ulong(layout.channels * layout.Stride()));
  device.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(layout.Stride(), layout.channels));
}
}
