#include "LightPropagation/Sweep/SweepVolume.h"

#include "Medium/BoxFaces.h"

namespace tyndall
{
SweepVolume GroupVolume(
  const VolumeLayout& layout, const ChannelGroup& group, const Buffer<float>& sigma_t, const Deposit& deposit)
{
  SweepVolume volume;
  volume.grid = layout.grid;
  volume.channels = group.count;
  volume.stride = layout.Stride();
  volume.sigma_t = &sigma_t;
  volume.sigma_t_first = layout.ExtinctionFirst(group.first);
  volume.deposit = deposit;
  volume.first = group.first * layout.Stride();
  volume.faceFirst = group.first * BoxFaceCellCount(layout.grid);
  volume.firstChannel = group.first;
  return volume;
}

VolumeArrays ArraysOf(const SweepVolume& volume, const Buffer<float>* lost)
{
  const Buffer<float>& path = *volume.deposit.path;
  const auto orPath = [&path](const Buffer<float>* array) -> const Buffer<float>& { return array ? *array : path; };
  return { *volume.sigma_t, orPath(volume.source), orPath(volume.octantSource), path, orPath(lost),
    orPath(volume.deposit.flux), orPath(volume.deposit.partialCurrents) };
}

void ReserveOnDevice(Device& device, Buffer<float>& buffer, std::size_t floats, const char* what)
{
  if (buffer.Size() < floats)
  {
    buffer = {};
    buffer = Buffer<float>(device, floats, what, CL_MEM_READ_WRITE, Residence::Device);
  }
}

void SweepWorkspace::Reserve(Device& device, std::size_t mapFloats, std::size_t scratchFloats)
{
  ReserveOnDevice(device, this->maps, mapFloats, "the light propagation maps");
  ReserveOnDevice(device, this->scratch, scratchFloats, "the planes being crossed");
}

void SweepWorkspace::ReserveLost(Device& device, std::size_t floats)
{
  if (this->lost.Size() < floats)
  {
    this->lost = {};
    this->lost = Buffer<float>(device, floats, "what rounding takes from the light gathered");
  }
}

void SweepWorkspace::ReserveSlots(Device& device, const SlotSizes& floats)
{
  for (std::size_t i = 0; i < floats.size(); ++i)
  {
    ReserveOnDevice(device, this->slots[i], floats[i], "slices of the volume");
  }
}

SweepVolume SweepByGroups::VolumeOf(std::size_t group, const Buffer<float>* source) const
{
  SweepVolume volume = GroupVolume(this->Layout, this->Layout.Groups()[group], this->SigmaT, this->Request.deposit);
  volume.box = this->Request.box;
  volume.source = source;
  volume.angular = this->Request.angular;
  volume.deposit.flux = volume.angular ? nullptr : volume.deposit.flux;
  volume.faceIn = this->Request.faceIn;
  volume.octantSource = this->Request.octantSource;
  volume.skipsEmpty = this->Request.skipsEmpty;
  volume.moments = this->Layout.Places(volume.angular ? volume.angular->Functions() : 1);
  return volume;
}

SweepTally SweepByGroups::Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor)
{
  SweepTally tally;
  const std::vector<ChannelGroup> groups = this->Layout.Groups();
  const double all = static_cast<double>(groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    const int first = groups[g].first;
    const SweepBoundary ofChannels = OfGroup(boundary, first);
    const Monitor ofGroup = OfPart(monitor, g / all, (g + 1) / all);
    Add(tally, this->ApplyGroup(g, this->VolumeOf(g, source), ofChannels, ofGroup), first);
  }
  return tally;
}
}
