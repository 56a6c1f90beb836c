#include "LightPropagation/Uncollided/NarrowLight.h"

#include "Device/Device.h"
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

namespace
{
/// Runs a kernel of NarrowLight.cl whose arguments are the memory layout of the moments, then `arguments`.
template <class... Arguments>
void RunOnMoments(Device& device, const VolumeLayout& layout, const AngularBasis& basis, const char* name,
  const Arguments&... arguments)
{
  cl::Kernel kernel = device.Kernel(name, kernel_source::NarrowLight, Define("DEGREE", basis.Degree()));
  With(kernel, layout.Places(basis.Count()), arguments...);
  const std::array<int, 3>& size = layout.grid.size;
  device.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, cl::NDRange(size[0], static_cast<std::size_t>(size[1]) * size[2], layout.channels));
  device.Finish(); // the kernel must end before the caller releases the arrays
}
}

void NarrowLight::AddAlong(const std::array<double, 3>& omega) const
{
  const VolumeLayout& layout = this->Volume.layout;
  const AngularBasis& basis = *this->Volume.basis;
  const Buffer<float> values(this->Volume.device, Floats(basis.At(omega)), "the angular functions");
  RunOnMoments(this->Volume.device, layout, basis, "add_beam_moments", values, *this->To().path,
    *this->Volume.deposit.path, cl_ulong(layout.Stride()));
}

void NarrowLight::AddAlongFlux() const
{
  AddNarrowMoments(this->Volume.device, this->Volume.layout, *this->Volume.basis, *this->To().path, this->Flux,
    *this->Volume.deposit.path);
}

void AddNarrowMoments(Device& device, const VolumeLayout& layout, const AngularBasis& basis, const Buffer<float>& path,
  const Buffer<float>& flux, const Buffer<float>& moments, float peak)
{
  const Buffer<float> matrix(device, Floats(basis.Matrix()), "the angular functions");
  RunOnMoments(
    device, layout, basis, "add_narrow_moments", matrix, path, flux, moments, cl_ulong(layout.Stride()), peak);
}
}
