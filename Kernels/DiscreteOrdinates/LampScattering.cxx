#include "DiscreteOrdinates/LampScattering.h"

#include "Device/Defines.h"
#include "DiscreteOrdinates/LampScatteringShared.h"
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
constexpr int TableSize = 1024;
constexpr int MeansDegree = 256; ///< of moments; a cell's mean has forgotten those beyond

/// The phase function averaged over a cell, over the angle from 0 to pi; nowhere negative. 1/sr
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
    table.push_back(static_cast<float>(std::max(mean, 0.0))); // series have ripples
  }
  return table;
}
}

LampScattering::LampScattering(
  Device& device, const Grid& grid, const OrdinateGroups& groups, const PhaseFunction& function)
  : TheDevice(device)
  , TheGrid(grid)
  , GroupCount(groups.Count())
  , MeanCosine(function.MeanCosine())
{
  std::vector<float> omegas;
  for (int g = 0; g < groups.Count(); ++g)
  {
    for (int part = 0; part < 4; ++part)
    {
      for (int lane = 0; lane < OrdinateLanes; ++lane)
      {
        omegas.push_back(static_cast<float>(part < 3 ? groups.Of(g, lane).omega[part] : groups.Weight(g, lane)));
      }
    }
  }
  const double solidAngle = 4.0 * Pi / static_cast<double>(groups.TheDirections().size());
  this->Omegas = Buffer<float>(device, omegas, "the directions");
  this->Table = Buffer<float>(device, MeansByAngle(function, solidAngle), "the phase function");
}

void LampScattering::Add(
  const Light& lamp, const Buffer<float>& path, const Buffer<float>& sigma_s, const LampTarget& target) const
{
  const bool parallel = lamp.type == LightType::Directional;
  const glm::dvec3 origin(this->TheGrid.origin[0], this->TheGrid.origin[1], this->TheGrid.origin[2]);
  const glm::dvec3 place =
    parallel ? glm::normalize(Vector(lamp.direction)) : glm::dvec3(Vector(lamp.position)) - origin;
  LampInRays info = {};
  for (int a = 0; a < 3; ++a)
  {
    info.size[a] = this->TheGrid.size[a];
    info.spacing[a] = static_cast<float>(this->TheGrid.spacing[a]);
    info.place[a] = static_cast<float>(place[a]);
  }
  info.meanCosine = static_cast<float>(this->MeanCosine);
  info.perVolume = static_cast<float>(1.0 / this->TheGrid.VoxelVolume());
  cl::Kernel scatter = this->TheDevice.Kernel("scatter_lamp", kernel_source::LampScattering,
    Define("GROUPS", this->GroupCount) + Define("TABLE", TableSize) + Define("POINT", !parallel));
  With(scatter, target.source, target.scale, path, sigma_s, this->Omegas, this->Table, target.light.fluence,
    target.direct, target.light.flux, cl_int(target.light.flux.Size() > 0), info);
  this->TheDevice.Queue().enqueueNDRangeKernel(scatter, cl::NullRange, cl::NDRange(this->TheGrid.VoxelCount()));
  this->TheDevice.Finish();
}
}
