#include "LightPropagation/Uncollided/NarrowLight.h"

#include "Device/Defines.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
namespace
{
std::vector<float> Floats(const std::vector<double>& values)
{
  return { values.begin(), values.end() };
}
}

NarrowLight::NarrowLight(const UncollidedVolume& volume, bool withFlux)
  : Volume(volume)
  , OwnPath(volume.device, volume.beamPath ? 0 : volume.layout.Floats(), "the light of a lamp")
  , Flux(volume.device, withFlux ? volume.layout.Floats(3) : 0, "the light of a lamp")
{
  this->OwnPath.Fill(0.0f);
  this->Flux.Fill(0.0f);
}

Deposit NarrowLight::To() const
{
  Deposit to = this->Volume.deposit;
  to.path = this->Volume.beamPath ? this->Volume.beamPath : &this->OwnPath;
  to.flux = this->Flux.Size() > 0 ? &this->Flux : nullptr;
  return to;
}

void NarrowLight::AddAlong(const std::array<double, 3>& omega) const
{
  const VolumeLayout& layout = this->Volume.layout;
  Device& device = this->Volume.device;
  const Buffer<float> values(device, Floats(this->Volume.basis->At(omega)), "the angular functions");
  cl::Kernel add = device.Kernel(
    "add_beam_moments", kernel_source::NarrowLight, Define("DEGREE", this->Volume.basis->Degree()) + Define("RAYS", 0));
  With(add, values, *this->To().path, *this->Volume.deposit.path, cl_ulong(layout.Stride()),
    cl_ulong(layout.channels * layout.Stride()));
  device.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(layout.Stride(), layout.channels));
  device.Finish(); // the arrays go
}

void NarrowLight::AddAlongFlux() const
{
  const VolumeLayout& layout = this->Volume.layout;
  Device& device = this->Volume.device;
  const Buffer<float> basis(device, Floats(this->Volume.basis->Matrix()), "the angular functions");
  cl::Kernel add = device.Kernel("add_narrow_moments", kernel_source::NarrowLight,
    Define("DEGREE", this->Volume.basis->Degree()) + Define("RAYS", 1));
  With(add, basis, *this->To().path, this->Flux, *this->Volume.deposit.path, cl_ulong(layout.Stride()),
    cl_ulong(layout.channels * layout.Stride()));
  device.Queue().enqueueNDRangeKernel(add, cl::NullRange, cl::NDRange(layout.Stride(), layout.channels));
  device.Finish(); // the arrays go
}
}
