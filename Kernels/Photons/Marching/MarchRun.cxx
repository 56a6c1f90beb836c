#include "Photons/Marching/MarchRun.h"

#include "Device/Batches.h"
#include "Device/Defines.h"
#include "Device/GroupSize.h"
#include "Device/Sizes.h"
#include "Photons/Marching/MarchLaunch.h"

#include <algorithm>
#include <numeric>

namespace tyndall
{
namespace
{
constexpr std::size_t FirstLaunch = 16384; ///< photons; its duration determines the size of the next launch

/// Indices of the first photon of each batch, and one past the last, for photons ordered by batch.
std::vector<int> BeginsOf(const std::vector<PhotonOnItsWay>& photons, int batches)
{
  std::vector<int> begins(static_cast<std::size_t>(batches) + 1, 0);
  for (const PhotonOnItsWay& photon : photons)
  {
    ++begins[static_cast<std::size_t>(photon.batch) + 1];
  }
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  return begins;
}
}

/// Photons of one round.
struct MarchRun::Marched
{
  PhotonsOnDevice starting;
  Buffer<PhotonOnItsWay> arrived;
  bool resumes; ///< march the arrived photons, not the starting ones
};

MarchRun::MarchRun(const MarchMedium& medium, const MarchSums& target, const PackedPhotons& packed)
  : Medium(medium)
  , Info(medium.Describe())
  , Target(target)
  , Channels(packed.channels)
  , Kernel(medium.IsBlock() ? MarchKernelFor(medium, target, packed.channels, "march_block", Define("BLOCKS", 1))
                            : cl::Kernel())
{
}

void MarchRun::GoAsFarAs(const TurnSchedule& turn)
{
  this->Info.pause = static_cast<cl_int>(turn.gone);
  this->Info.eventLimit = turn.last ? this->Info.pause : this->Medium.EventLimit();
}

MarchRun::Outcome MarchRun::Start(
  const PackedPhotons& photons, const std::vector<cl_ulong>& marks, const Monitor& monitor)
{
  Device& device = this->Medium.device;
  if (!this->Medium.IsBlock())
  {
    const PhotonsOnDevice onDevice(device, photons, marks);
    MarchPhotons(this->Medium, photons, onDevice, this->Target, monitor);
    return { onDevice.ends.Read(), {} };
  }
  return this->March(
    { PhotonsOnDevice(device, photons, marks), Buffer<PhotonOnItsWay>(device, 0, "photons from other blocks"), false },
    photons.batchBegin, monitor);
}

MarchRun::Outcome MarchRun::Resume(std::vector<PhotonOnItsWay> arrived, const Monitor& monitor)
{
  std::stable_sort(
    arrived.begin(), arrived.end(), [](const PhotonOnItsWay& a, const PhotonOnItsWay& b) { return a.batch < b.batch; });
  PackedPhotons none;
  none.channels = this->Channels;
  none.batchBegin = { 0, 0 };
  none.numbers.resize(arrived.size()); // as many as there will be end records
  Device& device = this->Medium.device;
  return this->March(
    { PhotonsOnDevice(device, none), Buffer<PhotonOnItsWay>(device, arrived, "photons from other blocks"), true },
    BeginsOf(arrived, this->Target.shares.batches), monitor);
}

MarchRun::Outcome MarchRun::March(const Marched& photons, const std::vector<int>& batchBegin, const Monitor& monitor)
{
  Outcome outcome;
  const double all = batchBegin.back();
  for (std::size_t batch = 0; batch + 1 < batchBegin.size(); ++batch)
  {
    if (const auto begin = batchBegin[batch], end = batchBegin[batch + 1]; begin < end)
    {
      this->MarchBatch(photons, static_cast<int>(batch), static_cast<std::size_t>(begin), static_cast<std::size_t>(end),
        OfPart(monitor, begin / all, end / all), outcome.gone);
    }
  }
  outcome.ends = photons.starting.ends.Read();
  return outcome;
}

/// Marches photons `begin` to `end`, which belong to one batch.
void MarchRun::MarchBatch(const Marched& photons, int batch, std::size_t begin, std::size_t end, const Monitor& monitor,
  std::vector<PhotonOnItsWay>& gone)
{
  Device& device = this->Medium.device;
  const MarchShares& shares = this->Target.shares;
  const std::size_t width = Count(device.KernelWidth());
  // Stride between copies of a batch; each copy has a worker of its own.
  const std::size_t stride = shares.copies > 1 ? this->Target.records * Count(this->Target.numbers) : 0;
  const auto workers =
    static_cast<std::size_t>(shares.workers > 0 ? (shares.copies - batch + shares.batches - 1) / shares.batches : 0);
  Batches launches;
  launches.count = end - begin;
  launches.first = FirstLaunch;
  launches.whole = Count(MarchBlock) * std::max<std::size_t>(workers, 1);
  launches.seconds = SecondsPerLaunch;
  launches.growth = 8.0;
  launches.most = std::max(MarchedBetweenBlocks, launches.whole);
  const Buffer<cl_int> none(device, 0, "cells of the voxels");
  GonePhotons<PhotonOnItsWay> elsewhere(device, std::min(launches.count, launches.most));
  Buffer<cl_int> next(device, 1, "number of the next photon");
  const std::size_t before = gone.size();
  InBatches(device, launches, monitor, [&](std::size_t first, std::size_t size) {
    elsewhere.Empty();
    next.Fill(0);
    With(this->Kernel, this->Info, this->Medium.sigma, this->Medium.coefficients, this->Medium.nodes,
      photons.starting.values, photons.starting.marks, photons.arrived, elsewhere.Room(), elsewhere.Number(),
      photons.starting.ends, *this->Target.sums, cl_ulong(Count(batch) * stride),
      cl_ulong(Count(shares.batches) * stride), next, cl_int(photons.resumes), cl_int(begin + first), cl_int(size),
      this->Target.cells ? *this->Target.cells : none);
    this->Medium.Launch(this->Kernel, cl::NDRange(workers > 0 ? workers : PartsOf(size, width)),
      workers > 0 ? cl::NDRange(1) : GroupOfLargeItems(device));
    elsewhere.AppendTo(gone);
  });
  for (std::size_t i = before; i < gone.size(); ++i)
  {
    gone[i].batch = batch;
  }
}
}
