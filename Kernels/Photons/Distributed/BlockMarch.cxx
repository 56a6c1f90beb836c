#include "Photons/Distributed/BlockMarch.h"

#include "Device/Batches.h"
#include "Device/Defines.h"
#include "Device/GroupSize.h"
#include "Device/Sizes.h"

#include <algorithm>

namespace tyndall
{
namespace
{
constexpr double SecondsPerLaunch = 0.1;
constexpr std::size_t FirstLaunch = 16384; ///< photons; how long they take says how many go next
constexpr std::size_t MostAtOnce = 262144; ///< room for those that go into other blocks: 30 MiB
}

BlockMarch::BlockMarch(const MarchMedium& medium, const MarchSums& target, const PackedPhotons& packed)
  : Medium(medium)
  , Target(target)
  , Channels(packed.channels)
  , Kernel(MarchKernelFor(medium, target, packed.channels, "march_block", Define("BLOCKS", 1)))
{
}

BlockMarch::Outcome BlockMarch::Start(
  const PackedPhotons& photons, const std::vector<cl_ulong>& marks, const Monitor& monitor)
{
  const PhotonsOnDevice onDevice(this->Medium.device, photons, marks);
  const Buffer<PhotonOnItsWay> none(this->Medium.device, 0, "photons from other blocks");
  return this->March(onDevice, none, photons.Count(), false, monitor);
}

BlockMarch::Outcome BlockMarch::Resume(const std::vector<PhotonOnItsWay>& arrived, const Monitor& monitor)
{
  PackedPhotons none;
  none.channels = this->Channels;
  none.batchBegin = { 0, 0 };
  none.numbers.resize(arrived.size()); // for as many ends
  const PhotonsOnDevice onDevice(this->Medium.device, none);
  return this->March(onDevice, Buffer<PhotonOnItsWay>(this->Medium.device, arrived, "photons from other blocks"),
    arrived.size(), true, monitor);
}

BlockMarch::Outcome BlockMarch::March(const PhotonsOnDevice& photons, const Buffer<PhotonOnItsWay>& arrived,
  std::size_t count, bool resumes, const Monitor& monitor)
{
  Outcome outcome;
  if (count == 0)
  {
    return outcome;
  }
  Device& device = this->Medium.device;
  const MarchShares& shares = this->Target.shares;
  const std::size_t workers = static_cast<std::size_t>(shares.workers), width = Count(device.KernelWidth());
  const std::size_t stride = shares.copies > 1 ? this->Target.records * Count(this->Target.numbers) : 0;
  Batches launches;
  launches.count = count;
  launches.first = FirstLaunch;
  launches.whole = Count(MarchBlock) * std::max<std::size_t>(workers, 1);
  launches.seconds = SecondsPerLaunch;
  launches.growth = 8.0;
  launches.most = std::max(MostAtOnce, launches.whole);
  const Buffer<PhotonOnItsWay> gone(device, std::min(count, launches.most), "photons into other blocks");
  Buffer<cl_int> goneCount(device, 1, "number of photons into other blocks"),
    next(device, 1, "number of the next photon");
  InBatches(device, launches, monitor, [&](std::size_t first, std::size_t size) {
    goneCount.Fill(0);
    next.Fill(0);
    With(this->Kernel, this->Medium.Describe(), this->Medium.sigma, this->Medium.coefficients, this->Medium.nodes,
      photons.values, photons.marks, arrived, gone, goneCount, photons.ends, *this->Target.sums, cl_ulong(stride), next,
      cl_int(resumes), cl_int(first), cl_int(size));
    this->Medium.Launch(this->Kernel, cl::NDRange(workers > 0 ? workers : PartsOf(size, width)),
      workers > 0 ? cl::NDRange(1) : GroupOfLargeItems(device));
    const std::size_t before = outcome.gone.size(), more = static_cast<std::size_t>(goneCount.Read().front());
    outcome.gone.resize(before + more);
    gone.Read(outcome.gone.data() + before, more);
  });
  outcome.ends = photons.ends.Read();
  return outcome;
}
}
