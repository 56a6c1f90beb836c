#include "LightPropagation/Sweep/SweepInMemory.h"

#include "LightPropagation/Sweep/OnGpu/SweepOnGpu.h"

#include <utility>

namespace tyndall
{
std::unique_ptr<SweepOperator> SweepOfDevice(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
  const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace)
{
  if (!device.IsCpu())
  {
    return std::make_unique<SweepOnGpu>(device, layout, sigma_t, periodic, request, workspace);
  }
  return std::make_unique<SweepInMemory>(device, layout, sigma_t, periodic, request, workspace);
}

SweepInMemory::SweepInMemory(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
  const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace)
  : SweepByGroups(layout, sigma_t, request)
{
  for (const AxisBundles& along : request.rays)
  {
    if (along.bundles.empty())
    {
      continue;
    }
    Axis axis;
    const std::size_t sweeps = periodic[along.axis] ? layout.Groups().size() : 1;
    for (std::size_t g = 0; g < sweeps; ++g)
    {
      axis.ofGroups.push_back(
        std::make_unique<AxisSweep>(device, this->VolumeOf(g), along, periodic, workspace, request.sameBoundary));
    }
    this->Axes.push_back(std::move(axis));
  }
}

SweepTally SweepInMemory::ApplyGroup(
  std::size_t group, const SweepVolume& volume, const SweepBoundary& boundary, const Monitor& monitor)
{
  const double all = static_cast<double>(this->Axes.size());
  for (std::size_t a = 0; a < this->Axes.size(); ++a)
  {
    this->Axes[a].Of(group).Start(volume, boundary, this->Request.mostPlanes, OfPart(monitor, a / all, (a + 1) / all));
  }
  SweepTally tally;
  for (const Axis& axis : this->Axes)
  {
    Add(tally, axis.Of(group).Finish());
  }
  return tally;
}

void SweepInMemory::Forget()
{
  for (const Axis& axis : this->Axes)
  {
    for (const std::unique_ptr<AxisSweep>& sweep : axis.ofGroups)
    {
      sweep->Forget();
    }
  }
}
}
