#include "LightPropagation/Conservative/ShownLight.h"

#include "TyndallKernelSources.h"

#include <string>
#include <vector>

namespace tyndall
{
namespace
{
constexpr double MostBytes = 1024.0 * 1024.0 * 1024.0;

/// Number of spherical harmonics kept: all those of a degree limited by memory.
int HarmonicsKept(int degree, std::size_t values)
{
  const auto count = [](int l) { return (l + 1) * (l + 1); };
  while (degree > 1 && 4.0 * count(degree) * static_cast<double>(values) > MostBytes)
  {
    --degree;
  }
  return count(degree);
}

constexpr float LeastScattering = 1e-30f; ///< 1/length, in the solver's unit: weaker scattering is invisible

/// Factor from source to scattered radiance per mean free path of scattering: 1 / sigma_s, or 0 where sigma_s is
/// negligible.
Buffer<float> PerScattering(Device& device, const VolumeLayout& layout, const Field& sigma_s)
{
  const auto inverse = [&](std::size_t i, int c) {
    return sigma_s.At(i, c) > LeastScattering ? 1.0f / sigma_s.At(i, c) : 0.0f;
  };
  return PlanarOnDevice(device, layout, layout.channels, inverse, "the inverse of sigma_s");
}
}

ShownLight::ShownLight(const Medium& medium, const TruncatedScattering& scattering, const AngularBasis& basis,
  const VolumeLayout& layout, std::size_t values)
  : TheMedium(medium)
  , Scattering(scattering)
  , Basis(basis)
  , Layout(layout)
  , Harmonics(HarmonicsKept(basis.Degree(), values))
{
  for (std::size_t i = 0; i < layout.grid.VoxelCount(); ++i)
  {
    for (int c = 1; c < layout.channels; ++c)
    {
      this->Coloured = this->Coloured || scattering.StraightOn(i, c) != scattering.StraightOn(i, 0);
    }
  }
}

/// [voxel], or [voxel][channel] if channels differ.
std::vector<float> ShownLight::StraightOn() const
{
  const int channels = this->Coloured ? this->Layout.channels : 1;
  std::vector<float> part(this->Layout.grid.VoxelCount() * channels);
  for (std::size_t i = 0; i < part.size(); ++i)
  {
    part[i] = this->Scattering.StraightOn(i / channels, static_cast<int>(i % channels));
  }
  return part;
}

void ShownLight::AddTo(
  LightField& light, Device& device, const Buffer<float>& shown, const Buffer<float>& scratch) const
{
  const int functions = this->Basis.Count();
  const std::vector<double> matrix = this->Basis.Matrix();
  const Buffer<float> basis(device, std::vector<float>(matrix.begin(), matrix.end()), "the angular functions");
  const Buffer<float> scale = PerScattering(device, this->Layout, this->TheMedium.sigma_s);
  const std::array<int, 3>& size = this->Layout.grid.size;
  for (int c = 0; c < this->Layout.channels; ++c)
  {
    cl::Kernel kernel = device.Kernel("to_harmonics", kernel_source::MomentScattering);
    With(
      kernel, this->Layout.Places(functions), cl_int(c), basis, shown, scale, cl_ulong(this->Layout.Stride()), scratch);
    device.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(size[0], static_cast<std::size_t>(size[1]) * size[2], this->Harmonics));
  }
  light.scatteredMoments.resize(this->Layout.grid.VoxelCount() * this->Layout.channels * this->Harmonics);
  scratch.Read(light.scatteredMoments.data(), light.scatteredMoments.size());
  light.straightOn = this->StraightOn();
  if (this->Harmonics < functions)
  {
    light.leftOut.push_back("angular moments for pictures: " + std::to_string(this->Harmonics) + " of " +
      std::to_string(functions) + ", more take above 1 GiB");
  }
}
}
