#include "LightPropagation/Sweep/Pipelined/BlockCrossing.h"

#include "Device/Device.h"
#include "LightPropagation/Sweep/OnCpu/SweepKernel.h"

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
}
