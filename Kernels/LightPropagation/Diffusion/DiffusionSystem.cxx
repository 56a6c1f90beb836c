#include "LightPropagation/Diffusion/DiffusionSystem.h"

#include "Device/Defines.h"
#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"

#include "TyndallKernelSources.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr double Floor = 0.05;     ///< optical length between centres of voxels that pass light as if it were that long
constexpr double Reduction = 1e-3; ///< of the residual in one correction: sweeps gain less than that

int OtherAxis(int axis, int which)
{
  const PlaneAxes axes = AcrossAxis(axis);
  return which == 0 ? axes.u : axes.v;
}

double FaceArea(const Grid& grid, int axis)
{
  return grid.spacing[(axis + 1) % 3] * grid.spacing[(axis + 2) % 3];
}

/// Of `Arrays`, where a channel begins.
template <class Arrays>
DiffusionLayout LayoutOf(const Grid& grid, const std::array<bool, 3>& periodic, const Arrays& arrays)
{
  DiffusionLayout layout = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    layout.size[axis] = grid.size[axis];
    layout.periodic[axis] = periodic[axis];
    layout.spacing[axis] = static_cast<float>(grid.spacing[axis]);
  }
  layout.stride = static_cast<cl_int>(arrays.stride);
  layout.firstT = static_cast<cl_int>(arrays.firstT);
  layout.first = static_cast<cl_int>(arrays.first);
  return layout;
}

/// @param passing  lamps' light passes faces at once where it is scattered
cl::Kernel DiffusionKernel(Device& device, const char* name, bool passing)
{
  return device.Kernel(name, kernel_source::DiffusionSystem, ExactOption(device) + Define("PASSING", passing));
}

/// Rounding can leave dark faces a little below 0: they become 0, and the others are scaled so that the sum stays.
std::array<double, 6> NotNegative(std::array<double, 6> powers)
{
  const double sum = std::accumulate(powers.begin(), powers.end(), 0.0);
  double positive = 0.0;
  for (double& power : powers)
  {
    power = std::max(power, 0.0);
    positive += power;
  }
  for (double& power : powers)
  {
    power *= positive > 0.0 ? std::max(sum, 0.0) / positive : 0.0;
  }
  return powers;
}

/// sum over directions of w mu, mu > 0, that march along `marching`.
double HalfRange(const Grid& grid, const DirectionSet& set, int axis, int marching)
{
  double sum = 0.0;
  for (const Direction& direction : set.directions)
  {
    sum += PartMarching(grid, direction.omega, marching) * direction.weight * std::max(direction.omega[axis], 0.0);
  }
  return sum;
}

/// Power at radiance 1 that crosses faces across `axis` upwards in each plane, per area, of rays that march along
/// `marching`.
std::vector<double> CrossingsIn(
  const Grid& grid, const DirectionSet& set, int mapResolution, RayStarts starts, int axis, int marching)
{
  const int planes = grid.size[marching];
  const bool isU = AcrossAxis(marching).u == axis;
  std::vector<double> power(planes, 0.0);
  for (const Bundle& bundle : BundlesAlong(marching, grid, {}, set, mapResolution, starts))
  {
    for (int k = 0; k < planes; ++k)
    {
      const PlaneCrossing crossing = bundle.Crossing(k);
      for (int s = 1; s < crossing.count; ++s)
      {
        for (const Member& member : bundle.members)
        {
          const int fromU = isU ? member.uFromU : member.vFromU;
          const int fromV = isU ? member.uFromV : member.vFromV;
          const int move = fromU * crossing.segments[s].moveU + fromV * crossing.segments[s].moveV;
          if (move > 0)
          {
            const double crosses = crossing.segments[s].part * bundle.power / FaceArea(grid, axis);
            power[k] += crosses;
            power[planes - 1 - k] += crosses;
          }
        }
      }
    }
  }
  return power;
}
}

void PassLampLight(Device& device, const Grid& grid, const std::array<bool, 3>& periodic, const LampLight& light)
{
  DiffusionLayout layout = LayoutOf(grid, periodic, light);
  layout.linear = true;
  cl::Kernel pass = DiffusionKernel(device, "diffusion_pass", true);
  With(pass, layout, *light.sigma_t, *light.sigma_a, *light.sigma_s, *light.path, *light.moments, *light.passed,
    *light.allPath);
  device.Queue().enqueueNDRangeKernel(
    pass, cl::NullRange, MultigridSolver::Range(layout.size), MultigridSolver::Group());
}

CrossingPattern FindCrossingPattern(
  const Grid& grid, const DirectionSet& set, int mapResolution, RayStarts starts, const std::array<bool, 3>& periodic)
{
  CrossingPattern pattern;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double straight = HalfRange(grid, set, axis, axis);
    double all = straight;
    for (int which = 0; which < 2; ++which)
    {
      all += HalfRange(grid, set, axis, OtherAxis(axis, which));
    }
    for (int which = 0; which < 2; ++which)
    {
      const int marching = OtherAxis(axis, which);
      std::vector<double> power = CrossingsIn(grid, set, mapResolution, starts, axis, marching);
      if (periodic[marching]) // rays go round and round: the mean is what counts
      {
        std::fill(power.begin(), power.end(), HalfRange(grid, set, axis, marching));
      }
      pattern.first[2 * axis + which] = static_cast<int>(pattern.values.size());
      for (double crossing : power)
      {
        pattern.values.push_back(static_cast<float>((crossing + (which == 0 ? straight : 0.0)) / all));
      }
    }
  }
  return pattern;
}

DiffusionSystem::DiffusionSystem(Device& device, const Grid& grid, const std::array<bool, 3>& periodic,
  const DirectionSet& directions, const CrossingPattern& pattern, const Arrays& arrays,
  const std::array<double, 6>& incoming, bool linear)
  : TheDevice(device)
  , The(arrays)
  , Count(grid.VoxelCount())
  , Solver(device, grid.size, grid.spacing)
  , Mixing(device, grid.VoxelCount(), "the diffusion system")
{
  double halfRange = 0.0;
  for (int marching = 0; marching < 3; ++marching)
  {
    halfRange += HalfRange(grid, directions, 0, marching) / (4.0 * Pi);
  }
  this->Layout = LayoutOf(grid, periodic, arrays);
  this->Layout.linear = linear;
  std::copy(pattern.first.begin(), pattern.first.end(), this->Layout.pattern);
  this->Layout.halfRange = static_cast<float>(halfRange);
  this->Layout.floor = static_cast<float>(Floor);
  std::copy(incoming.begin(), incoming.end(), this->Layout.incoming);

  const char* what = "the diffusion system";
  this->Pattern = Buffer<float>(device, pattern.values, what);
  this->FlatSource = Buffer<float>(device, 3 * arrays.stride, what);
  this->Model = Buffer<float>(device, this->Count, what);
  this->Right = ExactValues(device, this->Count, what);
  this->Given = ExactValues(device, this->Count, what);
  this->Solution = ExactValues(device, this->Count, what);
  this->Solution.Fill(0.0); // a dark channel is never solved for
  this->Borders = ExactValues(device, 4 * BoxFaceCellCount(grid), what);

  cl::Kernel flat_source = this->Kernel("diffusion_flat_source");
  With(flat_source, this->Layout, *arrays.sigma_t, this->FlatSource);
  this->Run(flat_source);
  cl::Kernel conductance = this->Kernel("diffusion_conductance");
  With(conductance, this->Layout, *arrays.sigma_t, *arrays.sigma_a, this->FlatSource, this->Solver.Conductance(),
    this->Solver.Loss());
  this->Run(conductance);
  this->Solver.Coarsen();
}

cl::Kernel DiffusionSystem::Kernel(const char* name) const
{
  return DiffusionKernel(this->TheDevice, name, this->The.passed != nullptr);
}

void DiffusionSystem::Run(cl::Kernel& kernel)
{
  this->TheDevice.Queue().enqueueNDRangeKernel(
    kernel, cl::NullRange, this->Solver.Range(this->Layout.size), MultigridSolver::Group());
}

template <class... More>
void DiffusionSystem::RunOnArrays(const char* name, const More&... more)
{
  const Arrays& the = this->The;
  cl::Kernel kernel = this->Kernel(name);
  With(kernel, this->Layout, *the.sigma_t, *the.sigma_a, this->FlatSource, this->Solver.Conductance(),
    *the.partialCurrents, this->The.passed ? *this->The.passed : this->Model, this->Model, this->Pattern, *the.source,
    *the.path, more...);
  this->Run(kernel);
}

void DiffusionSystem::WriteSource()
{
  cl::Kernel kernel = this->Kernel("diffusion_source");
  With(kernel, this->Layout, *this->The.given, *this->The.sigma_s, this->Given.Handle(), *this->The.sigma_t,
    *this->The.sigma_a, this->Solver.Conductance(), this->The.passed ? *this->The.passed : this->Model,
    *this->The.source);
  this->Run(kernel);
}

double DiffusionSystem::Correct(double unit)
{
  const Arrays& the = this->The;
  cl::Kernel model = this->Kernel("diffusion_model");
  With(model, this->Layout, *the.sigma_t, *the.path, this->Given.Handle(), *the.source, this->Model);
  this->Run(model);
  this->RunOnArrays("diffusion_balance", *the.given, this->Right.Handle());
  this->Solver.Solve(this->Right, this->Solution, unit, Reduction);

  const auto& h = this->Layout.spacing;
  const float edge = std::cbrt(h[0] * h[1] * h[2]); // the same whichever axis is which
  return this->Mixing.Mix(this->Given, this->Solution, { the.sigma_s, the.first, edge });
}

std::array<double, 6> DiffusionSystem::Outflow(const std::array<double, 6>& ofSweep)
{
  this->RunOnArrays("diffusion_outflow", this->Solution.Handle(), this->Borders.Handle());
  const std::vector<double> borders = this->Borders.Read();
  std::array<double, 6> outflow = {};
  std::array<double, 6> missing = ofSweep; // of what seems to leave
  double transport_weight = 0.0, shared = 0.0;
  std::size_t at = 0;
  for (int face = 0; face < 6; ++face)
  {
    const PlaneAxes axes = AcrossAxis(face / 2);
    for (int i = 0; i < this->Layout.size[axes.u] * this->Layout.size[axes.v]; ++i, at += 4)
    {
      outflow[face] += borders[at];
      missing[face] -= borders[at + 1];
      const bool several = borders[at + 2] > 0.0;
      transport_weight += several ? borders[at + 2] : 0.0;
      shared += several ? 1.0 : 0.0;
    }
  }
  const double all = std::accumulate(missing.begin(), missing.end(), 0.0);
  const double left = std::accumulate(ofSweep.begin(), ofSweep.end(), 0.0);
  for (int face = 0; face < 6 && shared > 0.0 && left > 0.0; ++face)
  {
    outflow[face] +=
      this->Layout.periodic[face / 2] ? 0.0 : transport_weight / shared * (missing[face] - all * ofSweep[face] / left);
  }
  return NotNegative(outflow);
}

SurfacePowers DiffusionSystem::PowersAtSurface() const
{
  const std::vector<double> borders = this->Borders.Read();
  SurfacePowers powers;
  powers.halfRange = this->Layout.halfRange;
  std::size_t at = 3;
  for (int face = 0; face < 6; ++face)
  {
    powers.in[face] = this->Layout.incoming[face];
    const PlaneAxes axes = AcrossAxis(face / 2);
    const double area = this->Layout.spacing[axes.u] * this->Layout.spacing[axes.v];
    for (int i = 0; i < this->Layout.size[axes.u] * this->Layout.size[axes.v]; ++i, at += 4)
    {
      powers.net.push_back(borders[at] / area);
    }
  }
  return powers;
}

void DiffusionSystem::AddFlux(const Buffer<float>& flux)
{
  this->RunOnArrays("diffusion_flux", this->Solution.Handle(), flux);
}
}
