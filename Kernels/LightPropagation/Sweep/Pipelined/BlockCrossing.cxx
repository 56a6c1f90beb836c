#include "LightPropagation/Sweep/Pipelined/BlockCrossing.h"

#include "LightPropagation/Sweep/Pipelined/BlockCrossingOnCpu.h"
#include "LightPropagation/Sweep/Pipelined/BlockCrossingOnGpu.h"

namespace tyndall
{
std::size_t RaysOfBlock::SideFloats() const
{
  return static_cast<std::size_t>(this->plan.plane.sizeU) + this->plan.plane.sizeV + 1;
}

std::size_t RaysOfBlock::Sides() const
{
  return this->plan.radianceEachWay * this->plan.Planes() * this->SideFloats();
}

std::unique_ptr<BlockCrossing> MakeBlockCrossing(
  Device& device, const RaysOfBlock& rays, const SweepVolume& volume, BlockWorkspace& workspace)
{
  ReserveOnDevice(device, workspace.sidesIn, rays.Sides(), "the rays that come in from other blocks");
  ReserveOnDevice(device, workspace.sidesOut, rays.Sides(), "the rays that go out to other blocks");
  if (device.IsCpu())
  {
    return std::make_unique<BlockCrossingOnCpu>(device, rays, volume.grid.size[1], workspace);
  }
  return std::make_unique<BlockCrossingOnGpu>(device, rays, workspace);
}

BlockArrays::BlockArrays(const RaysOfBlock& rays, const SweepVolume& volume, const BlockWorkspace& workspace)
  : path(*volume.deposit.path)
  , lost(rays.around ? workspace.sweep.lost : this->path)
  , flux(volume.deposit.flux ? *volume.deposit.flux : this->path)
  , currents(volume.deposit.partialCurrents ? *volume.deposit.partialCurrents : this->path)
  , source(volume.source ? *volume.source : this->path)
  , octants(volume.octantSource ? *volume.octantSource : this->path)
{
}
}
