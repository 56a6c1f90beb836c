#include "LightPropagation/Sweep/Pipelined/BlockCrossing.h"

#include "Device/Device.h"
#include "LightPropagation/Sweep/OnCpu/SweepKernel.h"
#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"
#include "LightPropagation/Sweep/OnGpu/PlaneKernels.h"
#include "TyndallKernelSources.h"

#include <algorithm>

namespace tyndall
{
namespace
{
/// Carries rays through a block with the kernel `sweep` (OnCpu/Sweep.cl). Maps have the layout of SweepBorder::maps.
class BlockCrossingOnCpu final : public BlockCrossing
{
public:
  BlockCrossingOnCpu(Device& device, const RaysOfBlock& rays, BlockWorkspace& workspace)
    : TheDevice(device)
    , Rays(rays)
    , Workspace(workspace)
    , Kernel(device, rays.plan)
    , Schedule(device, rays.plan.schedule, "the schedule")
  {
    workspace.sweep.Reserve(device, rays.plan.eachWay.maps, rays.plan.units.size() * rays.plan.ScratchFloats());
  }

  std::size_t MapFloats() const override { return this->Rays.plan.eachWay.maps; }

  std::size_t RowOfMap(const BundleInfo& bundle, std::size_t slot, int v) const override
  {
    const SweepPlan& plan = this->Rays.plan;
    const std::size_t slots = static_cast<std::size_t>(bundle.members) * plan.channels;
    return bundle.map + (v * slots + slot) * plan.row + plan.vector;
  }

  void LayPattern(int planes) override
  {
    const SweepPlan& plan = this->Rays.plan;
    this->Crossings =
      Buffer<CrossingInfo>(this->TheDevice, plan.Crossings(planes, plan.CrossingPlanes()), "the ray pattern");
    this->Kernel.SetOwnLight(plan.OwnLight(planes));
  }

  std::vector<float> Cross(const SweepVolume& volume, const std::vector<cl_float4>& beyond, int outerSides,
    RaysAtFaces& rays, const Monitor& monitor) override
  {
    this->SetBorder(beyond);
    this->Workspace.sweep.maps.Write(rays.maps.data(), rays.maps.size());
    this->Workspace.sidesIn.Write(rays.sides.data(), rays.sides.size());
    this->Launch(volume, outerSides, monitor);
    this->Workspace.sweep.maps.Read(rays.maps.data(), rays.maps.size());
    this->Workspace.sidesOut.Read(rays.sides.data(), rays.sides.size());
    return this->Kernel.Sideways();
  }

private:
  /// Sets the incident power of each ray, W, in the arrays of both senses of marching, of which the kernel reads one.
  void SetBorder(const std::vector<cl_float4>& beyond)
  {
    const SweepPlan& plan = this->Rays.plan;
    std::vector<float> outside(2 * plan.eachWay.outside, 0.0f), radiance(2 * plan.eachWay.radiance, 0.0f);
    for (const BundleInfo& bundle : plan.bundleRows)
    {
      for (int slot = 0; slot < bundle.members * plan.channels; ++slot)
      {
        const int ray = bundle.border + slot;
        const std::size_t row = bundle.outside + static_cast<std::size_t>(slot) * plan.row + plan.vector;
        for (int way = 0; way < 2; ++way)
        {
          std::fill_n(outside.data() + way * plan.eachWay.outside + row, plan.plane.sizeU, beyond[ray].s[1]);
          radiance[way * plan.eachWay.radiance + ray] = beyond[ray].s[0];
        }
      }
    }
    this->Kernel.SetBorder(outside, radiance);
  }

  void Launch(const SweepVolume& volume, int outerSides, const Monitor& monitor)
  {
    const SweepPlan& plan = this->Rays.plan;
    SweepInfo info = this->Kernel.InfoOf(volume, this->Rays.around);
    info.eachWay.maps = 0; // the maps hold only one sense of marching
    info.shines = volume.source != nullptr;
    info.outerSides = outerSides;
    SweepKernel::Crossing crossing = { info,
      ArraysOf(volume, this->Rays.around ? &this->Workspace.sweep.lost : nullptr), this->Workspace.sweep.maps,
      this->Workspace.sweep.scratch, this->Crossings, this->Schedule, this->Workspace.sidesIn.Handle(),
      this->Workspace.sidesOut.Handle(), plan.secondsPerLaunch };
    cl::Kernel kernel = this->Kernel.Make(false, false, true);
    for (int launch = 0; launch < plan.launches; ++launch)
    {
      this->Kernel.Launch(kernel, crossing, launch);
      Report(monitor, (launch + 1.0) / plan.launches);
    }
  }

  Device& TheDevice;
  RaysOfBlock Rays;
  BlockWorkspace& Workspace;
  SweepKernel Kernel;
  Buffer<cl_int2> Schedule;
  Buffer<CrossingInfo> Crossings;
};
}

std::unique_ptr<BlockCrossing> MakeBlockCrossingOnCpu(
  Device& device, const RaysOfBlock& rays, BlockWorkspace& workspace)
{
  return std::make_unique<BlockCrossingOnCpu>(device, rays, workspace);
}

namespace
{
/// Carries a block's rays with the kernels of Sweep/OnGpu and their option SIDES (SweepOnGpuShared.h), as one lane
/// (rays of one sense along an axis), which adds to the deposit. Maps are [ray][channel][v][u]. Arrays in host memory
/// are streamed through the device in slices.
class BlockCrossingOnGpu final : public BlockCrossing
{
public:
  BlockCrossingOnGpu(Device& device, const RaysOfBlock& rays, BlockWorkspace& workspace);

  std::size_t MapFloats() const override
  {
    return this->Plan.eachWay.radiance * this->Plan.plane.sizeU * this->Plan.plane.sizeV;
  }

  std::size_t RowOfMap(const BundleInfo& bundle, std::size_t slot, int v) const override
  {
    return ((bundle.border + slot) * this->Plan.plane.sizeV + v) * this->Plan.plane.sizeU;
  }

  void LayPattern(int planes) override
  {
    const SweepPlan& plan = this->Plan;
    this->Crossings = Buffer<CrossingInfo>(
      this->TheDevice, plan.Crossings(planes + plan.PlanesBefore(this->Rays.way), plan.Planes()), "the ray pattern");
  }

  std::vector<float> Cross(const SweepVolume& volume, const std::vector<cl_float4>& beyond, int outerSides,
    RaysAtFaces& rays, const Monitor& monitor) override;

private:
  std::unique_ptr<LaneSlices> MakeSlices();
  void Launch(const SweepVolume& volume, int outerSides, const Monitor& monitor);
  std::vector<float> SumsOfSides();
  /// Power of each ray before plane k, counted from the block's first plane.
  const Buffer<float>& Maps(int k) const { return k % 2 == 0 ? this->Workspace.sweep.maps : this->Workspace.otherMaps; }

  Device& TheDevice;
  RaysOfBlock Rays;
  const SweepPlan& Plan; ///< plan of `Rays`
  BlockWorkspace& Workspace;
  SweepLane Lane;
  /// Slices of a block in host memory; null: the block is on the device or is swept in place
  std::unique_ptr<LaneSlices> Slices;

  Buffer<SweepLane> Lanes; ///< device copy of `Lane`, one element
  Buffer<BundleInfo> Bundles;
  Buffer<CrossingInfo> Crossings;
  /// Values of the angular functions in the rays' directions, if there are angular moments
  Buffer<float> Functions;
  /// Power of light incident from outside the domain, W, [ray][channel]: x through the face normal to u, y through the
  /// face normal to v
  Buffer<cl_float4> Beyond;
  /// Left: power that escapes sideways, W, [plane][-u, +u, -v, +v][channel][position along the face]. Sides: its sums
  /// over the positions
  Buffer<float> Left, Sides;
};

BlockCrossingOnGpu::BlockCrossingOnGpu(Device& device, const RaysOfBlock& rays, BlockWorkspace& workspace)
  : TheDevice(device)
  , Rays(rays)
  , Plan(rays.plan)
  , Workspace(workspace)
  , Lane(LaneOf(rays.plan, rays.way))
{
  const SweepPlan& plan = this->Plan;
  this->Lane.around = rays.around;
  workspace.sweep.Reserve(device, this->MapFloats(), 0);
  ReserveOnDevice(device, workspace.otherMaps, this->MapFloats(), "the light propagation maps");
  if (plan.angular)
  {
    ReserveOnDevice(device, workspace.directed, this->MapFloats(), "what shines along the rays");
    this->Functions = Buffer<float>(device, FunctionsAlong(plan, rays.way, *plan.angular), "the angular functions");
  }
  this->Bundles = Buffer<BundleInfo>(device, plan.bundleRows, "the bundles of rays");
  this->Beyond = Buffer<cl_float4>(device, plan.eachWay.radiance, "the light that comes in sideways");
  const std::size_t rows = std::size_t{ 4 } * plan.Planes() * plan.channels;
  ReserveOnDevice(device, this->Left, rows * this->Lane.positions, "the power that leaves sideways");
  this->Left.Fill(0.0f); // positions beyond the end of the block's shorter faces remain zero
  this->Sides = Buffer<float>(device, rows, "sums");
  this->Slices = this->MakeSlices();
  this->Lanes = Buffer<SweepLane>(device, std::vector<SweepLane>{ this->Lane }, "the rays' way");
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

/// Creates the slices of a block whose arrays are in host memory. The grid of the slices is that of the block, since
/// these arrays have no other voxels.
std::unique_ptr<LaneSlices> BlockCrossingOnGpu::MakeSlices()
{
  if (!this->TheDevice.Streams())
  {
    return nullptr;
  }
  SweepPlan plan = this->Plan;
  plan.grid.size = plan.box.size;
  plan.box.first = {};
  // If the marching axis is periodic, the array `lost` (rounding errors of path integrals) is streamed too.
  plan.periodic[plan.axes.axis] = this->Rays.around;
  return LaneSlices::Make(this->TheDevice, plan, this->Lane, this->Workspace.sweep);
}

/// Carries the rays through all planes of the block, one plane after another.
void BlockCrossingOnGpu::Launch(const SweepVolume& volume, int outerSides, const Monitor& monitor)
{
  const SweepPlan& plan = this->Plan;
  const VolumeArrays arrays = ArraysOf(volume, this->Rays.around ? &this->Workspace.sweep.lost : nullptr);
  PlaneLaunch launch = {};
  launch.sigmaFirst = volume.sigma_t_first;
  launch.sourceFirst = volume.source ? volume.first : 0;
  launch.putFirst = volume.first;
  launch.stride = volume.stride;
  launch.firstChannel = volume.firstChannel;
  launch.shines = volume.source != nullptr;
  launch.adds = launch.inPlaces = 1;
  launch.outerSides = outerSides;
  launch.moments = plan.moments;
  const PlaneRays rays = { this->Lanes, this->Bundles, this->Crossings, this->Beyond,
    { &this->Maps(0), &this->Maps(1) }, plan.angular ? this->Workspace.directed : arrays.path,
    plan.angular ? this->Functions : arrays.path, this->Left, this->Workspace.sidesIn, this->Workspace.sidesOut };
  PlaneKernels kernels(
    this->TheDevice, plan, SidesOfBlock, { plan.plane.sizeU, plan.plane.sizeV, 1, plan.eachWay.radiance });
  kernels.Cross(volume, launch, arrays, this->Slices.get(), rays, plan.Planes(), monitor);
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

std::unique_ptr<BlockCrossing> MakeBlockCrossingOnGpu(
  Device& device, const RaysOfBlock& rays, BlockWorkspace& workspace)
{
  return std::make_unique<BlockCrossingOnGpu>(device, rays, workspace);
}
}
