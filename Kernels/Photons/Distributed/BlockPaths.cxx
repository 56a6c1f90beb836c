#include "Photons/Distributed/BlockPaths.h"

#include "Device/Defines.h"
#include "Device/GroupSize.h"
#include "Photons/Distributed/GonePhotons.h"
#include "Photons/Marching/MarchLaunch.h"

namespace tyndall
{
BlockPaths::BlockPaths(const MarchMedium& medium, int channels)
  : Medium(medium)
  , Channels(channels)
  , Kernel(medium.MarchKernel("trace_in_block", channels, false, PathOptions() + Define("BLOCKS", 1)))
{
}

std::vector<PhotonOnItsWay> BlockPaths::Start(
  const PackedPhotons& photons, const std::vector<cl_ulong>& marks, std::vector<Part>& parts)
{
  return this->Trace(photons, {}, marks, false, parts);
}

std::vector<PhotonOnItsWay> BlockPaths::Resume(const std::vector<PhotonOnItsWay>& arrived, std::vector<Part>& parts)
{
  PackedPhotons none;
  none.channels = this->Channels;
  none.batchBegin = { 0, 0 };
  none.numbers.resize(arrived.size()); // for as many ends
  std::vector<cl_ulong> marks;
  for (const PhotonOnItsWay& photon : arrived)
  {
    marks.push_back(photon.mark);
  }
  return this->Trace(none, arrived, marks, true, parts);
}

std::vector<PhotonOnItsWay> BlockPaths::Trace(const PackedPhotons& photons, const std::vector<PhotonOnItsWay>& arrived,
  const std::vector<cl_ulong>& marks, bool resumes, std::vector<Part>& parts)
{
  std::vector<PhotonOnItsWay> into;
  if (marks.empty())
  {
    return into;
  }
  Device& device = this->Medium.device;
  const PhotonsOnDevice onDevice(device, photons, marks);
  const Buffer<PhotonOnItsWay> come(device, arrived, "photons from other blocks");
  GonePhotons<PhotonOnItsWay> gone(device, marks.size());
  CornersOfWays corners = TraceCorners(this->Medium, marks.size(),
    [&](bool counting, const Buffer<cl_int>& offsets, const Buffer<cl_float4>& to, const Buffer<cl_int>& counts) {
      gone.Empty();
      With(this->Kernel, this->Medium.Describe(), this->Medium.sigma, this->Medium.coefficients, this->Medium.nodes,
        onDevice.values, onDevice.marks, come, gone.Room(), gone.Number(), onDevice.ends, cl_int(counting), offsets, to,
        counts, cl_int(resumes));
      this->Medium.Launch(this->Kernel, cl::NDRange(marks.size()), GroupOfLargeItems(device));
    });
  gone.AppendTo(into);
  for (std::size_t i = 0; i < marks.size(); ++i)
  {
    parts.push_back({ marks[i], std::move(corners[i]) });
  }
  return into;
}
}
