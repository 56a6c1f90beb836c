#include "DiscreteOrdinates/LampScattering.h"

#include "Device/Device.h"
#include "DiscreteOrdinates/OrdinatesShared.h"
#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"
#include "Numerics/Vectors.h"
#include "PhaseFunction/SeparablePhaseFunction.h"
#include "TyndallKernelSources.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
/// Largest |t| in the factor 1 + t cosine of Eq. (D12); equal to MOST_TILT in LampScattering.cl.
constexpr double MostTilt = 0.98;
constexpr double Least = 1e-9; ///< smallest value of the tabulated phase function, 1/sr
constexpr int TableSize = 1024;
/// Highest degree of the Legendre moments that are summed; averaged over a direction's solid angle, higher moments are
/// negligible.
constexpr int MeansDegree = 256;

/// Phase function averaged over the solid angle of one direction, 1/sr, at equidistant angles from 0 to pi. All values
/// are positive, so that normalisation does not divide by 0 for narrow peaks.
std::vector<float> MeansByAngle(const PhaseFunction& function, double solidAngle)
{
  const std::vector<double> moments = function.Moments(MeansDegree), cap = CapMoments(solidAngle, MeansDegree);
  std::vector<float> table;
  for (int i = 0; i < TableSize; ++i)
  {
    const double cosine = std::cos(Pi * i / (TableSize - 1));
    const std::vector<double> p = LegendrePolynomials(MeansDegree, cosine);
    double mean = 0.0;
    for (int l = 0; l <= MeansDegree; ++l)
    {
      mean += (2.0 * l + 1.0) / (4.0 * Pi) * moments[l] * cap[l] * p[l];
    }
    table.push_back(static_cast<float>(std::max(mean, Least))); // the truncated series oscillates and may be negative
  }
  return table;
}
}

LampScattering::LampScattering(
  Device& device, const Grid& grid, const OrdinateGroups& groups, const PhaseFunction& function)
  : TheDevice(device)
  , TheGrid(grid)
  , Groups(groups)
  , MeanCosine(function.MeanCosine())
{
  const std::vector<float> omegas = groups.Table(
    4, [&](int g, int part, int lane) { return part < 3 ? groups.Of(g, lane).omega[part] : groups.Weight(g, lane); });
  const double solidAngle = 4.0 * Pi / static_cast<double>(groups.TheDirections().size());
  this->Omegas = Buffer<float>(device, omegas, "the directions");
  this->ByAngle = MeansByAngle(function, solidAngle);
  this->Table = Buffer<float>(device, this->ByAngle, "the phase function");
}

/// Phase function between a ray and each direction, 1/sr, [group][direction of the group] (part_i of numerics.md, Eq.
/// (D12)). It is corrected so that its integral over the directions is 1 and, as far as all values remain positive, its
/// mean cosine is exact.
std::vector<float> LampScattering::PartsAlong(const std::array<double, 3>& ray) const
{
  const auto cosine = [&](int g, int lane) {
    const std::array<double, 3>& omega = this->Groups.Of(g, lane).omega;
    return std::clamp(ray[0] * omega[0] + ray[1] * omega[1] + ray[2] * omega[2], -1.0, 1.0);
  };
  const auto phase = [&](int g, int lane) {
    const double position = std::acos(cosine(g, lane)) / Pi * (TableSize - 1);
    const int i = std::min(static_cast<int>(position), TableSize - 2);
    return this->ByAngle[i] + (position - i) * (this->ByAngle[i + 1] - this->ByAngle[i]);
  };
  double sum = 0.0, mean = 0.0, square = 0.0;
  for (int g = 0; g < this->Groups.Count(); ++g)
  {
    for (int lane = 0; lane < OrdinateLanes; ++lane)
    {
      const double part = phase(g, lane) * this->Groups.Weight(g, lane);
      sum += part;
      mean += part * cosine(g, lane);
      square += part * cosine(g, lane) * cosine(g, lane);
    }
  }
  mean /= sum;
  square /= sum;
  const double lacking = this->MeanCosine - mean, slope = square - this->MeanCosine * mean;
  const double tilt =
    slope > 1e-6 ? std::clamp(lacking / slope, -MostTilt, MostTilt) : std::copysign(MostTilt, lacking);
  return this->Groups.Table(
    [&](int g, int lane) { return phase(g, lane) * (1.0 + tilt * cosine(g, lane)) / (sum * (1.0 + tilt * mean)); });
}

cl::Kernel LampScattering::Kernel(const char* name, bool ways) const
{
  return this->TheDevice.Kernel(name, kernel_source::LampScattering,
    Define("GROUPS", this->Groups.Count()) + Define("TABLE", TableSize) + Define("WAYS", ways));
}

void LampScattering::AddAlong(
  const Buffer<float>& ways, const Buffer<float>& path, const Buffer<float>& sigma_s, const LampTarget& target) const
{
  LampInRays info = {};
  info.meanCosine = static_cast<float>(this->MeanCosine);
  info.perVolume = static_cast<float>(1.0 / this->TheGrid.VoxelVolume());
  const cl::NDRange voxels(this->TheGrid.VoxelCount());
  cl::Kernel add = this->Kernel("add_lamp", true), scatter = this->Kernel("scatter_from_place", true);
  With(add, path, target.light.fluence, target.direct, target.light.flux, cl_int(target.light.flux.Size() > 0), info,
    ways);
  With(scatter, target.source, target.scale, path, sigma_s, this->Omegas, this->Table,
    static_cast<cl_ulong>(OrdinateStride(this->TheGrid.VoxelCount())), info, ways);
  Launch(this->TheDevice, add, voxels);
  Launch(this->TheDevice, scatter, voxels);
  target.scale.Fill(1.0f);
  this->TheDevice.Finish();
}

void LampScattering::Add(
  const Light& lamp, const Buffer<float>& path, const Buffer<float>& sigma_s, const LampTarget& target) const
{
  const bool parallel = lamp.type == LightType::Directional;
  const glm::dvec3 origin(this->TheGrid.origin[0], this->TheGrid.origin[1], this->TheGrid.origin[2]);
  const glm::dvec3 place = parallel ? Vector(DirectionOf(lamp)) : Vector(lamp.position) - origin;
  LampInRays info = {};
  for (int a = 0; a < 3; ++a)
  {
    info.size[a] = this->TheGrid.size[a];
    info.spacing[a] = static_cast<float>(this->TheGrid.spacing[a]);
    info.place[a] = static_cast<float>(place[a]);
  }
  info.parallel = parallel;
  info.meanCosine = static_cast<float>(this->MeanCosine);
  info.perVolume = static_cast<float>(1.0 / this->TheGrid.VoxelVolume());
  const cl::NDRange voxels(this->TheGrid.VoxelCount());
  const cl_ulong stride = OrdinateStride(this->TheGrid.VoxelCount());
  cl::Kernel add = this->Kernel("add_lamp", false);
  With(add, path, target.light.fluence, target.direct, target.light.flux, cl_int(target.light.flux.Size() > 0), info,
    Buffer<float>());
  Launch(this->TheDevice, add, voxels);
  if (parallel)
  {
    const Buffer<float> parts(this->TheDevice, this->PartsAlong({ place.x, place.y, place.z }), "the phase function");
    cl::Kernel scatter = this->Kernel("scatter_parallel", false);
    With(scatter, target.source, target.scale, path, sigma_s, parts, stride, info.perVolume);
    const cl::NDRange all(this->TheGrid.VoxelCount(), this->Groups.Count());
    Launch(this->TheDevice, scatter, all);
    this->TheDevice.Finish(); // the kernel reads `parts`, which is destroyed at the end of this block
  }
  else
  {
    cl::Kernel scatter = this->Kernel("scatter_from_place", false);
    With(scatter, target.source, target.scale, path, sigma_s, this->Omegas, this->Table, stride, info, Buffer<float>());
    Launch(this->TheDevice, scatter, voxels);
  }
  target.scale.Fill(1.0f);
  this->TheDevice.Finish();
}
}
