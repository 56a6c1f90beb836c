#include "LightPropagation/Conservative/ShownLight.h"

#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr double MostBytes = 1024.0 * 1024.0 * 1024.0;

/// Spherical harmonics that are kept, of all degrees up to one.
int HarmonicsKept(const TransportParts& parts)
{
  int degree = parts.Basis->Degree();
  const auto count = [](int l) { return (l + 1) * (l + 1); };
  while (
    degree > 1 && 4.0 * count(degree) * static_cast<double>(parts.Layout.channels * parts.Layout.Stride()) > MostBytes)
  {
    --degree;
  }
  return count(degree);
}

constexpr float LeastScattering = 1e-30f; ///< 1/length, in the solver's unit: of less nothing is ever seen

/// Radiance that is scattered of a source of 1.
std::vector<float> PerScattering(const TransportParts& parts)
{
  const Field& sigma_s = parts.Problem.TheMedium().sigma_s;
  return Planar(parts.Layout, parts.Layout.channels,
    [&](std::size_t i, int c) { return sigma_s.At(i, c) > LeastScattering ? 1.0f / sigma_s.At(i, c) : 0.0f; });
}

/// [voxel], or [voxel][channel] where channels differ.
std::vector<float> StraightOn(const TransportParts& parts)
{
  const TruncatedScattering& scattering = parts.Problem.Scattering();
  const int channels = parts.Layout.channels;
  std::vector<float> part(parts.Layout.grid.VoxelCount() * channels);
  bool alike = true;
  for (std::size_t i = 0; i < part.size(); ++i)
  {
    part[i] = scattering.StraightOn(i / channels, static_cast<int>(i % channels));
    alike = alike && part[i] == part[i - i % channels];
  }
  for (std::size_t i = 0; alike && i < parts.Layout.grid.VoxelCount(); ++i)
  {
    part[i] = part[i * channels];
  }
  part.resize(alike ? parts.Layout.grid.VoxelCount() : part.size());
  return part;
}
}

void AddShownLight(TransportParts& parts, const Buffer<float>& shown, LightField& light)
{
  const int harmonics = HarmonicsKept(parts), functions = parts.Functions();
  const std::vector<double> matrix = parts.Basis->Matrix();
  const Buffer<float> basis(parts.TheDevice, std::vector<float>(matrix.begin(), matrix.end()), "the angular functions");
  const Buffer<float> scale(parts.TheDevice, PerScattering(parts), "the inverse of sigma_s");
  const std::array<int, 3>& size = parts.Layout.grid.size;
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    cl::Kernel kernel = parts.TheDevice.Kernel("to_harmonics", kernel_source::MomentScattering);
    With(kernel, parts.Layout.Places(functions), cl_int(c), basis, shown, scale, cl_ulong(parts.Layout.Stride()),
      parts.Path);
    parts.TheDevice.Queue().enqueueNDRangeKernel(
      kernel, cl::NullRange, cl::NDRange(size[0], static_cast<std::size_t>(size[1]) * size[2], harmonics));
  }
  const std::size_t voxels = parts.Layout.grid.VoxelCount();
  light.scatteredMoments.resize(voxels * parts.Layout.channels * harmonics);
  parts.Path.Read(light.scatteredMoments.data(), light.scatteredMoments.size());
  light.straightOn = StraightOn(parts);
  if (harmonics < functions)
  {
    light.leftOut.push_back("angular moments for pictures: " + std::to_string(harmonics) + " of " +
      std::to_string(functions) + ", more take above 1 GiB");
  }
}
}
