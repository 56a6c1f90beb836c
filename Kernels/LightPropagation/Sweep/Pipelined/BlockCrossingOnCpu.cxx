#include "LightPropagation/Sweep/Pipelined/BlockCrossingOnCpu.h"

#include "Device/Defines.h"
#include "Device/ExactValues.h"
#include "LightPropagation/Sweep/SweepDefines.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
BlockCrossingOnCpu::BlockCrossingOnCpu(Device& device, const RaysOfBlock& rays, int sizeY, BlockWorkspace& workspace)
  : TheDevice(device)
  , Rays(rays)
  , Plan(rays.plan)
  , SizeY(sizeY)
  , Workspace(workspace)
{
  const SweepPlan& plan = this->Plan;
  workspace.sweep.Reserve(device, plan.mapsEachWay, plan.units.size() * plan.ScratchFloats());
  this->Outside = Buffer<float>(device, plan.outsideEachWay, "the light that comes in sideways");
  this->Radiance = Buffer<float>(device, 2 * plan.radianceEachWay, "the light that comes in sideways");
  this->Sideways =
    Buffer<float>(device, plan.units.size() * plan.Planes() * 4 * plan.channels, "the power that leaves sideways");
  this->Coefficients = Buffer<float>(
    device, plan.coefficients.empty() ? std::vector<float>{ 0.0f } : plan.coefficients, "the angular functions");
  this->Bundles = Buffer<BundleInfo>(device, plan.bundleRows, "the bundles of rays");
  this->Units = Buffer<UnitInfo>(device, plan.units, "the units of work");
  this->Schedule = Buffer<cl_int2>(device, plan.schedule, "the schedule");
  this->FunctionPlaces = Buffer<cl_int>(device, plan.FunctionPlaces(), "the angular functions");
}

std::size_t BlockCrossingOnCpu::MapFloats() const
{
  return this->Plan.mapsEachWay;
}

std::size_t BlockCrossingOnCpu::RowOfMap(const BundleInfo& bundle, std::size_t slot, int v) const
{
  const std::size_t slots = static_cast<std::size_t>(bundle.members) * this->Plan.channels;
  return bundle.map + (v * slots + slot) * this->Plan.row + this->Plan.vector;
}

void BlockCrossingOnCpu::LayPattern(int planes)
{
  const SweepPlan& plan = this->Plan;
  this->Crossings =
    Buffer<CrossingInfo>(this->TheDevice, plan.Crossings(planes, plan.CrossingPlanes()), "the ray pattern");
  this->OwnLight = Buffer<OwnLightInfo>(this->TheDevice, plan.OwnLight(planes), "the ray pattern");
}

std::vector<float> BlockCrossingOnCpu::Cross(const SweepVolume& volume, const std::vector<cl_float4>& beyond,
  int outerSides, RaysAtFaces& rays, const Monitor& monitor)
{
  this->WriteBeyond(beyond);
  this->Workspace.sweep.maps.Write(rays.maps.data(), rays.maps.size());
  this->Workspace.sidesIn.Write(rays.sides.data(), rays.sides.size());
  this->Launch(volume, outerSides, monitor);
  this->Workspace.sweep.maps.Read(rays.maps.data(), rays.maps.size());
  this->Workspace.sidesOut.Read(rays.sides.data(), rays.sides.size());
  return this->Sideways.Read();
}

void BlockCrossingOnCpu::WriteBeyond(const std::vector<cl_float4>& beyond)
{
  const SweepPlan& plan = this->Plan;
  std::vector<float> outside(plan.outsideEachWay, 0.0f), radiance(2 * plan.radianceEachWay, 0.0f);
  for (const BundleInfo& bundle : plan.bundleRows)
  {
    for (int slot = 0; slot < bundle.members * plan.channels; ++slot)
    {
      const int ray = bundle.border + slot;
      float* row = outside.data() + bundle.outside + static_cast<std::size_t>(slot) * plan.row + plan.vector;
      std::fill(row, row + plan.plane.sizeU, beyond[ray].s[1]);
      radiance[ray] = radiance[plan.radianceEachWay + ray] = beyond[ray].s[0];
    }
  }
  this->Outside.Write(outside.data());
  this->Radiance.Write(radiance.data());
}

cl::Kernel BlockCrossingOnCpu::Kernel()
{
  const SweepPlan& plan = this->Plan;
  const std::string options = DefinesOf(plan) + ExactOption(this->TheDevice) + Define("SIDES", 1) +
    Define("NET_FLUX", plan.netFlux) + Define("FACES", 0) + Define("PERIODIC", 0);
  return this->TheDevice.Kernel("sweep", kernel_source::Sweep, options);
}

SweepInfo BlockCrossingOnCpu::InfoOf(const SweepVolume& volume) const
{
  const SweepPlan& plan = this->Plan;
  SweepInfo info = {};
  info.sigmaFirst = volume.sigma_t_first;
  info.first = volume.first;
  info.stride = volume.stride;
  info.radianceEachWay = static_cast<uint>(plan.radianceEachWay); // the other buffers hold one way only
  info.coefficientsEachWay = static_cast<uint>(plan.coefficientsEachWay);
  info.bundles = static_cast<int>(plan.bundles.size());
  info.patternPlanes = plan.PatternPlanes();
  info.axis = plan.axes.axis;
  info.shines = volume.source != nullptr;
  info.roundAxis = this->Rays.around;
  info.planes = plan.plane;
  plan.DescribeMoments(info);
  info.sizeY = this->SizeY;
  info.firstChannel = volume.firstChannel;
  return info;
}

void BlockCrossingOnCpu::Launch(const SweepVolume& volume, int outerSides, const Monitor& monitor)
{
  const SweepPlan& plan = this->Plan;
  const BlockArrays of(this->Rays, volume, this->Workspace);
  SweepInfo info = this->InfoOf(volume);
  cl::Kernel kernel = this->Kernel();
  for (int launch = 0; launch < plan.launches; ++launch)
  {
    info.launch = launch;
    With(kernel, info, *volume.sigma_t, of.source, of.path, of.lost, of.flux, of.currents, this->Workspace.sweep.maps,
      this->Outside, this->Radiance, this->Workspace.sweep.scratch, this->Units, this->Bundles, this->Coefficients,
      this->Crossings, this->OwnLight, this->Schedule, this->Sideways, of.path, of.path, of.octants,
      this->FunctionPlaces, this->Workspace.sidesIn, this->Workspace.sidesOut, cl_int(outerSides));
    this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(plan.units.size()), cl::NDRange(1));
    this->TheDevice.Queued(plan.secondsPerLaunch);
    Report(monitor, (launch + 1.0) / plan.launches);
  }
}
}
