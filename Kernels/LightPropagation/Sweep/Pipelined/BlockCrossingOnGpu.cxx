#include "LightPropagation/Sweep/Pipelined/BlockCrossingOnGpu.h"

#include "Device/Defines.h"
#include "Device/Sizes.h"
#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"
#include "LightPropagation/Sweep/OnGpu/PlaneKernels.h"
#include "TyndallKernelSources.h"

namespace tyndall
{
BlockCrossingOnGpu::BlockCrossingOnGpu(Device& device, const RaysOfBlock& rays, BlockWorkspace& workspace)
  : TheDevice(device)
  , Rays(rays)
  , Plan(rays.plan)
  , Workspace(workspace)
  , Lane(LaneOf(rays.plan, rays.way))
{
  const SweepPlan& plan = this->Plan;
  workspace.sweep.Reserve(device, this->MapFloats(), 0);
  ReserveOnDevice(device, workspace.otherMaps, this->MapFloats(), "the light propagation maps");
  if (plan.angular)
  {
    ReserveOnDevice(device, workspace.directed, this->MapFloats(), "what shines along the rays");
    this->Functions = Buffer<float>(device, FunctionsAlong(plan, rays.way, *plan.angular), "the angular functions");
  }
  this->Bundles = Buffer<BundleInfo>(device, plan.bundleRows, "the bundles of rays");
  this->Beyond = Buffer<cl_float4>(device, plan.radianceEachWay, "the light that comes in sideways");
  const std::size_t rows = std::size_t{ 4 } * plan.Planes() * plan.channels;
  ReserveOnDevice(device, this->Left, rows * this->Lane.positions, "the power that leaves sideways");
  this->Left.Fill(0.0f); // the ends of rows of shorter faces stay zero
  this->Sides = Buffer<float>(device, rows, "sums");
  this->Slices = this->MakeSlices();
  this->Lanes = Buffer<SweepLane>(device, std::vector<SweepLane>{ this->Lane }, "the rays' way");
}

std::size_t BlockCrossingOnGpu::MapFloats() const
{
  return this->Plan.radianceEachWay * this->Plan.plane.sizeU * this->Plan.plane.sizeV;
}

std::size_t BlockCrossingOnGpu::RowOfMap(const BundleInfo& bundle, std::size_t slot, int v) const
{
  return ((bundle.border + slot) * this->Plan.plane.sizeV + v) * this->Plan.plane.sizeU;
}

void BlockCrossingOnGpu::LayPattern(int planes)
{
  const SweepPlan& plan = this->Plan;
  this->Crossings = Buffer<CrossingInfo>(
    this->TheDevice, plan.Crossings(planes + plan.PlanesBefore(this->Rays.way), plan.Planes()), "the ray pattern");
}

const Buffer<float>& BlockCrossingOnGpu::Maps(int k) const
{
  return k % 2 == 0 ? this->Workspace.sweep.maps : this->Workspace.otherMaps;
}

std::vector<float> BlockCrossingOnGpu::Cross(const SweepVolume& volume, const std::vector<cl_float4>& beyond,
  int outerSides, RaysAtFaces& rays, const Monitor& monitor)
{
  this->Beyond.Write(beyond.data());
  this->Workspace.sweep.maps.Write(rays.maps.data(), rays.maps.size());
  this->Workspace.sidesIn.Write(rays.sides.data(), rays.sides.size());
  this->Launch(volume, outerSides, monitor);
  this->Maps(this->Plan.Planes()).Read(rays.maps.data(), rays.maps.size());
  this->Workspace.sidesOut.Read(rays.sides.data(), rays.sides.size());
  return this->SumsOfSides();
}

std::string BlockCrossingOnGpu::Options(bool shines, bool octants) const
{
  const SweepPlan& plan = this->Plan;
  return Define("CHANNELS", plan.channels) + Define("SOURCE", shines) + Define("NET_FLUX", plan.netFlux) +
    Define("CURRENTS", plan.partialCurrents) + Define("OCTANT_SOURCE", octants && shines) +
    Define("DEGREE", plan.angular ? plan.angular->degree : 0) +
    Define("BEAMS", plan.angular ? plan.angular->Beams() : 0) + Define("ADDS", 1) +
    Define("AROUND", this->Rays.around) + Define("SIDES", 1);
}

/// Creates slices with the block as the grid, since the block's arrays hold no other voxels.
std::unique_ptr<LaneSlices> BlockCrossingOnGpu::MakeSlices()
{
  if (!this->TheDevice.Streams())
  {
    return nullptr;
  }
  SweepPlan plan = this->Plan;
  plan.grid.size = plan.box.size;
  plan.box.first = {};
  plan.periodic[plan.axes.axis] = this->Rays.around; // a periodic axis needs the array `lost`
  return LaneSlices::Make(this->TheDevice, plan, this->Lane, this->Workspace.sweep);
}

PlaneLaunch BlockCrossingOnGpu::LaunchOf(const SweepVolume& volume) const
{
  PlaneLaunch launch = {};
  launch.sigmaFirst = volume.sigma_t_first;
  launch.sourceFirst = volume.source ? volume.first : 0;
  launch.putFirst = volume.first;
  launch.stride = volume.stride;
  launch.firstChannel = volume.firstChannel;
  launch.moments = this->Plan.moments;
  return launch;
}

/// Crosses all planes, one after the other.
void BlockCrossingOnGpu::Launch(const SweepVolume& volume, int outerSides, const Monitor& monitor)
{
  const SweepPlan& plan = this->Plan;
  const BlockArrays of(this->Rays, volume, this->Workspace);
  // never read without angular moments
  const Buffer<float>& directed = plan.angular ? this->Workspace.directed : of.path;
  const Buffer<float>& functions = plan.angular ? this->Functions : of.path;
  const bool shines = volume.source != nullptr;
  const std::string options = this->Options(shines, volume.octantSource != nullptr);
  PlaneKernels kernels(
    this->TheDevice, options, plan.angular && shines, { plan.plane.sizeU, plan.plane.sizeV, 1, plan.radianceEachWay });
  kernels.SetSides(this->Workspace.sidesIn, this->Workspace.sidesOut, outerSides);
  const PlaneRays rays = { this->Lanes, this->Bundles, this->Crossings, this->Beyond,
    { &this->Maps(0), &this->Maps(1) }, directed, functions, this->Left };
  const auto crossed = [&](int behind) { Report(monitor, static_cast<double>(behind) / plan.Planes()); };
  const PlaneLaunch launch = this->LaunchOf(volume);
  if (!this->Slices)
  {
    kernels.Launch(launch, { *volume.sigma_t, of.source, of.octants, of.path, of.lost, of.flux, of.currents }, rays, 0,
      plan.Planes(), nullptr, nullptr, crossed);
    return;
  }
  SweepVolume shining = volume;
  shining.octantSource = shines ? volume.octantSource : nullptr;
  this->Slices->Cross(shining, launch,
    [&](const PlaneLaunch& inSlot, int from, int to, const std::vector<cl::Event>* after, cl::Event* done) {
      kernels.Launch(inSlot, this->Slices->Arrays(), rays, from, to, after, done, crossed);
    });
}

std::vector<float> BlockCrossingOnGpu::SumsOfSides()
{
  const int functions = this->Plan.angular ? this->Plan.angular->Functions() : 1;
  cl::Kernel kernel = this->TheDevice.Kernel(
    "sum_rows", kernel_source::LaneSums, Define("CHANNELS", this->Plan.channels) + Define("FUNCTIONS", functions));
  With(kernel, this->Left, cl_ulong(0), this->Lane.positions, this->Sides, cl_ulong(0));
  this->TheDevice.Queue().enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(this->Sides.Size()));
  return this->Sides.Read();
}
}
