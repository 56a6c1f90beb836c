#include "LightPropagation/Sweep/SweepInMemory.h"

#include <utility>

namespace tyndall
{
SweepInMemory::SweepInMemory(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
  const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace)
  : Layout(layout)
  , SigmaT(sigma_t)
  , To(request.deposit)
  , Box(request.box)
  , MostPlanes(request.mostPlanes)
  , Angular(request.angular)
  , FaceIn(request.faceIn)
  , OctantSource(request.octantSource)
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
      axis.ofGroups.push_back(std::make_unique<AxisSweep>(device, this->VolumeOf(layout.Groups()[g], nullptr),
        along.axis, along.bundles, periodic, workspace, request.sameBoundary));
    }
    this->Axes.push_back(std::move(axis));
  }
}

SweepVolume SweepInMemory::VolumeOf(const ChannelGroup& group, const Buffer<float>* source) const
{
  SweepVolume volume = GroupVolume(this->Layout, group, this->SigmaT, this->To);
  volume.box = this->Box;
  volume.source = source;
  volume.angular = this->Angular;
  volume.faceIn = this->FaceIn;
  volume.octantSource = this->OctantSource;
  volume.moments = this->Layout.Places(this->Angular ? this->Angular->Functions() : 1);
  volume.deposit.flux = this->Angular ? nullptr : volume.deposit.flux; // the flux is among the moments
  return volume;
}

SweepTally SweepInMemory::Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor)
{
  SweepTally tally;
  const std::vector<ChannelGroup> groups = this->Layout.Groups();
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    const int first = groups[g].first;
    const SweepBoundary ofChannels = OfGroup(boundary, first);
    const SweepVolume volume = this->VolumeOf(groups[g], source);
    const double all = static_cast<double>(this->Axes.size() * groups.size());
    for (std::size_t a = 0; a < this->Axes.size(); ++a)
    {
      const double before = static_cast<double>(g * this->Axes.size() + a);
      const Monitor ofAxis = OfPart(monitor, [=](double done) { return (before + done) / all; });
      this->Axes[a].Of(g).Start(volume, ofChannels, this->MostPlanes, ofAxis);
    }
    for (const Axis& axis : this->Axes)
    {
      Add(tally, axis.Of(g).Finish(), first);
    }
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
