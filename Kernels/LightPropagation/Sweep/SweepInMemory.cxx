#include "LightPropagation/Sweep/SweepInMemory.h"

#include <utility>

namespace tyndall
{
SweepInMemory::SweepInMemory(Device& device, const VolumeLayout& layout, const Description& description,
  const std::vector<AxisBundles>& axes, SweepWorkspace& workspace)
  : Layout(layout)
  , The(description)
{
  for (const AxisBundles& along : axes)
  {
    if (along.bundles.empty())
    {
      continue;
    }
    Axis axis;
    const std::size_t sweeps = description.periodic[along.axis] ? layout.Groups().size() : 1;
    for (std::size_t g = 0; g < sweeps; ++g)
    {
      axis.ofGroups.push_back(std::make_unique<AxisSweep>(device, this->VolumeOf(layout.Groups()[g], nullptr),
        along.axis, along.bundles, description.periodic, workspace));
    }
    this->Axes.push_back(std::move(axis));
  }
}

SweepVolume SweepInMemory::VolumeOf(const ChannelGroup& group, const Buffer<float>* source) const
{
  SweepVolume volume = GroupVolume(this->Layout, group, *this->The.sigma_t);
  volume.box = this->The.box;
  volume.source = source ? source : this->The.deposit.path; // never read where there is none
  volume.deposit = this->The.deposit;
  return volume;
}

SweepTally SweepInMemory::Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor)
{
  SweepTally tally;
  const std::vector<ChannelGroup> groups = this->Layout.Groups();
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    const int first = groups[g].first;
    const SweepBoundary ofChannels = boundary && first > 0
      ? SweepBoundary([&](int direction, int face) { return From(boundary(direction, face), first); })
      : boundary;
    const SweepVolume volume = this->VolumeOf(groups[g], source);
    const double all = static_cast<double>(this->Axes.size() * groups.size());
    for (std::size_t a = 0; a < this->Axes.size(); ++a)
    {
      const double before = static_cast<double>(g * this->Axes.size() + a);
      const Monitor ofAxis = OfPart(monitor, [=](double done) { return (before + done) / all; });
      this->Axes[a].Of(g).Start(volume, ofChannels, source != nullptr, this->The.mostPlanes, ofAxis);
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
