#include "Photons/Marching/MarchRun.h"

#include "Device/Device.h"
#include "Device/Sizes.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// On CPUs with at most this many compute units, each work-item has a private copy of the sums of deposits. With more
/// units, adding up the copies costs more than atomics.
constexpr int PrivateSumsAtMost = 8;
/// Number of consecutive photons that a work-item fetches at a time; they are neighbours in space.
constexpr int MarchBlock = 512;
/// Number of path segments in the first launch with straight rays. Two cores compute them in less than the intended
/// time of a launch.
constexpr double EventsPerLaunch = 4e7;
constexpr double FirstBent = 16384; ///< number of photons in the first launch with curved rays
/// Maximum number of photons per launch in a block of the domain: the buffer for photons that leave it has 30 MiB.
constexpr std::size_t MarchedBetweenBlocks = 262144;

bool HasAtomics(const Device& device)
{
  return device.HasExtension("cl_khr_int64_base_atomics");
}

bool NeedAtomics(const Device& device, MarchSettings::Sums sums)
{
  const bool atomics = HasAtomics(device);
  const bool few = device.IsCpu() && device.ComputeUnits() <= PrivateSumsAtMost;
  if (sums == MarchSettings::Sums::Shared && !atomics)
  {
    throw DeviceError(device.Name() +
      " has no 64-bit atomics (cl_khr_int64_base_atomics), which shared sums need. Choose private sums.");
  }
  return sums == MarchSettings::Sums::Shared || (sums == MarchSettings::Sums::Fitting && atomics && !few);
}

/// Number of photons in the first launch. For straight rays it follows from the number of voxels, which determines the
/// cost. For curved rays the first launch is small, since it measures the cost.
double FirstLaunch(const MarchMedium& medium)
{
  const double edges = (medium.grid.size[0] + medium.grid.size[1] + medium.grid.size[2]) / 3.0;
  const double straight = EventsPerLaunch / edges;
  return medium.bends ? std::min(straight, FirstBent * std::min(medium.settings.stepSize, 1.0)) : straight;
}

const std::vector<PhotonOnItsWay>& SortByBatch(std::vector<PhotonOnItsWay>& photons)
{
  std::stable_sort(
    photons.begin(), photons.end(), [](const PhotonOnItsWay& a, const PhotonOnItsWay& b) { return a.batch < b.batch; });
  return photons;
}

/// Index of the first photon of each batch, and one past the last photon, of photons sorted by batch.
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

MarchShares ShareSums(const MarchMedium& medium, std::size_t records, int numbers, int batches, std::size_t held)
{
  const Device& device = medium.device;
  MarchShares shares;
  shares.atomics = NeedAtomics(device, medium.settings.sums);
  shares.batches = shares.copies = batches;
  const std::size_t bytes = records * static_cast<std::size_t>(numbers) * sizeof(cl_long);
  const std::size_t free = device.MemoryLimit() - std::min(device.MemoryLimit(), device.BytesInUse() - held);
  const auto fitting = [&] { return std::min(device.AllocationLimit(), free / (shares.atomics ? 1 : 2)) / bytes; };
  const bool mayShare = medium.settings.sums == MarchSettings::Sums::Fitting && HasAtomics(device);
  if (mayShare && fitting() < static_cast<std::size_t>(std::max(device.ComputeUnits(), batches)))
  {
    shares.atomics = true; // atomic additions are slower than private sums, but all cores can be used
  }
  const std::size_t fit = fitting();
  if (batches > 1 && fit < static_cast<std::size_t>(batches))
  {
    throw DeviceError("The sums of " + std::to_string(batches) + " batches of photons need " +
      std::to_string(bytes / (1 << 20) * static_cast<std::size_t>(batches)) + " MiB, and " + device.Name() +
      " has room for " + std::to_string(fit) + " of them. Use fewer batches, or a coarser grid.");
  }
  if (!shares.atomics)
  {
    shares.workers =
      static_cast<int>(std::min(std::max<std::size_t>(fit, 1), static_cast<std::size_t>(device.ComputeUnits())));
    shares.copies = std::max(shares.workers, batches);
  }
  return shares;
}

PhotonsOnDevice::PhotonsOnDevice(
  Device& device, const PackedPhotons& packed, const std::vector<cl_ulong>& marksOfPhotons)
  : resumes(false)
  , starting(device, packed.values, "photons")
  , begins(packed.batchBegin)
  , batchBegin(device, begins, "batches of photons")
  , marks(device, marksOfPhotons, "marks of photons")
  , ends(device, packed.Count() * static_cast<std::size_t>(EndWords + packed.channels), "ends of photons")
{
}

PhotonsOnDevice::PhotonsOnDevice(Device& device, std::vector<PhotonOnItsWay> photons, int batches, int channels)
  : resumes(true)
  , arrived(device, SortByBatch(photons), "photons from other blocks")
  , begins(BeginsOf(photons, batches))
  , batchBegin(device, begins, "batches of photons")
  , marks(device, 0, "marks of photons")
  , ends(device, photons.size() * static_cast<std::size_t>(EndWords + channels), "ends of photons")
{
}

std::size_t PhotonsOnDevice::LargestBatch() const
{
  int largest = 0;
  for (std::size_t b = 1; b < this->begins.size(); ++b)
  {
    largest = std::max(largest, this->begins[b] - this->begins[b - 1]);
  }
  return static_cast<std::size_t>(largest);
}

MarchKernel::MarchKernel(
  const MarchMedium& medium, const MarchSums& target, int channels, const std::string& options, const char* name)
  : kernel(medium.MarchKernel(name, channels, target.directions,
      Define("REAL_WIDTH", medium.device.KernelWidth()) + Define("ATOMICS", target.shares.atomics) +
        Define("WORKERS", target.shares.workers) + Define("BLOCK", MarchBlock) + Define("PATHS", 0) +
        Define("COUNTS", target.counts) + Define("CELLS", target.cells != nullptr) + options))
  , Medium(medium)
  , Target(target)
  , None(medium.device, 0, "cells of the voxels")
{
}

cl_uint MarchKernel::Set(const PhotonsOnDevice& photons, MarchLaunch launch, const Buffer<cl_int>& counters)
{
  const MarchShares& shares = this->Target.shares;
  launch.copyStride = shares.copies > 1 ? this->Target.Stride() : 0;
  launch.copies = shares.copies;
  launch.batches = shares.batches;
  launch.resumes |= cl_int(photons.resumes);
  const Buffer<cl_int>& cells = this->Medium.bricks.AreThere() ? this->Medium.bricks.First()
    : this->Target.cells                                       ? *this->Target.cells
                                                               : this->None;
  With(this->kernel, this->Medium.Describe(), launch, this->Medium.sigma, this->Medium.coefficients, this->Medium.nodes,
    cells, photons.Handle(), photons.marks, photons.ends, *this->Target.sums, photons.batchBegin, counters);
  return 12;
}

cl::NDRange MarchKernel::Range(std::size_t photons) const
{
  const MarchShares& shares = this->Target.shares;
  return shares.workers > 0
    ? cl::NDRange(Count(shares.workers))
    : cl::NDRange(PartsOf(photons, Count(this->Medium.device.KernelWidth())), Count(shares.batches));
}

cl::NDRange MarchKernel::Group() const
{
  return this->Target.shares.workers > 0 ? cl::NDRange(1) : GroupOfLargeItems(this->Medium.device, 2);
}

// Launches are few and long, because work-items idle at the end of each launch.
Batches PhotonLaunches(
  const MarchMedium& medium, std::size_t photons, std::size_t first, std::size_t whole, int batches)
{
  constexpr double SecondsPerLaunch = 0.1;
  Batches launches;
  launches.count = photons;
  launches.first = first;
  launches.whole = whole;
  launches.seconds = SecondsPerLaunch;
  launches.growth = 8.0;
  if (medium.IsBlock())
  {
    launches.most = std::max(MarchedBetweenBlocks / Count(batches), whole);
  }
  return launches;
}

MarchRun::Outcome MarchRun::Start(
  const PackedPhotons& photons, const std::vector<cl_ulong>& marks, const Monitor& monitor)
{
  return this->March(PhotonsOnDevice(this->Medium.device, photons, marks), monitor);
}

MarchRun::Outcome MarchRun::Resume(std::vector<PhotonOnItsWay> arrived, const Monitor& monitor)
{
  return this->March(
    PhotonsOnDevice(this->Medium.device, std::move(arrived), this->Target.shares.batches, this->Channels), monitor);
}

MarchRun::Outcome MarchRun::March(const PhotonsOnDevice& photons, const Monitor& monitor)
{
  Device& device = this->Medium.device;
  const MarchShares& shares = this->Target.shares;
  const std::size_t batches = Count(shares.batches);
  const int sharing = (shares.workers + shares.batches - 1) / shares.batches; // number of work-items that share a batch
  const Batches launches = PhotonLaunches(this->Medium, photons.LargestBatch(),
    static_cast<std::size_t>(FirstLaunch(this->Medium) / shares.batches),
    Count(MarchBlock) * Count(std::max(sharing, 1)), shares.batches);
  const Buffer<PhotonOnItsWay> gone(device,
    this->Medium.IsBlock() ? batches * std::min(launches.count, launches.most) : 0, "photons into other blocks");
  Buffer<cl_int> counters(device, batches + 1, "numbers of the next photons");
  Outcome outcome;
  InBatches(device, launches, monitor, [&](std::size_t first, std::size_t count) {
    counters.Fill(0);
    MarchLaunch launch = {};
    launch.first = static_cast<cl_int>(first);
    launch.count = static_cast<cl_int>(count);
    const cl_uint next = this->Kernel.Set(photons, launch, counters);
    if (this->Medium.IsBlock())
    {
      SetFrom(this->Kernel.kernel, next, gone);
    }
    this->Medium.Launch(this->Kernel.kernel, this->Kernel.Range(count), this->Kernel.Group());
    if (this->Medium.IsBlock())
    {
      AppendPhotons(gone, counters.Read().back(), outcome.gone);
    }
  });
  outcome.ends = photons.ends.Read();
  return outcome;
}

namespace
{
struct Span
{
  double begin = 0.0, end = 0.0; ///< device times at which the commands between two events began and ended, s
};

Span SpanOf(const cl::Event& first, const cl::Event& last)
{
  return { 1e-9 * static_cast<double>(first.getProfilingInfo<CL_PROFILING_COMMAND_START>()),
    1e-9 * static_cast<double>(last.getProfilingInfo<CL_PROFILING_COMMAND_END>()) };
}

/// Number of path segments in each turn. A turn is a launch that follows photons over a limited number of segments; the
/// last turn follows them to their ends.
class TurnSchedule
{
public:
  /// Creates the schedule; Next begins the first turn.
  /// @param each   path segments per turn, MarchTurns::stretches
  /// @param limit  maximum number of path segments of a photon
  /// @param all    number of photons
  TurnSchedule(int each, int limit, std::size_t all)
    : Each(each)
    , Limit(limit)
    , All(all)
  {
  }

  /// Begins the next turn. It is the last one if fewer than a hundredth of all photons are left.
  /// @param left  number of photons that have not ended
  void Next(std::size_t left)
  {
    constexpr std::size_t few = 100;
    this->last = this->Each == 0 || left < this->All / few || this->Before + this->Each >= this->Limit;
    this->stretches = this->last ? this->Limit : this->Each;
    this->Before += this->stretches;
  }

  int stretches = 0; ///< maximum number of path segments per photon in the current turn (launch)
  bool last = false; ///< whether the current turn is the last

private:
  int Each, Limit;
  std::size_t All;
  std::int64_t Before = 0; ///< number of path segments per photon in all turns (launches) begun so far
};

/// State of the photons on the device between turns, and the kernel that marches them. A turn is a launch that follows
/// photons over a limited number of path segments.
class TurnsOfPhotons
{
public:
  TurnsOfPhotons(const MarchMedium& medium, const PhotonsOnDevice& photons, const MarchSums& target, int channels)
    : Photons(photons)
    , Packets(PartsOf(photons.LargestBatch(), Count(medium.device.KernelWidth())))
    , March(medium, target, channels, Define("TURNS", 1))
    , States(medium.device, this->Packets * this->BytesOfPacket(medium, target, channels), "photons on their way")
    , Going(medium.device, this->Packets, "photons on their way")
    , Counters(medium.device, 2, "number of the next photon, and of photons on their way")
  {
  }

  /// Queues one turn (launch over a limited number of path segments), and returns the event of the kernel.
  /// @param first  whether photons start in this turn
  cl::Event Turn(const cl::CommandQueue& queue, bool first, const TurnSchedule& turn)
  {
    queue.enqueueFillBuffer(this->Counters.Handle(), cl_int(0), 0, 2 * sizeof(cl_int));
    MarchLaunch launch = {};
    launch.count = static_cast<cl_int>(this->Photons.LargestBatch());
    launch.resumes = cl_int(!first);
    launch.events = turn.stretches;
    launch.last = cl_int(turn.last);
    const cl_uint next = this->March.Set(this->Photons, launch, this->Counters);
    SetFrom(this->March.kernel, next, this->States, this->Going);
    cl::Event marched;
    queue.enqueueNDRangeKernel(this->March.kernel, cl::NullRange, this->March.Range(this->Photons.LargestBatch()),
      this->March.Group(), nullptr, &marched);
    queue.flush();
    return marched;
  }
  /// Waits for the queue, and returns the number of photons that have not ended.
  std::size_t StillGoing(const cl::CommandQueue& queue) const
  {
    cl_int left = 0;
    queue.enqueueReadBuffer(this->Counters.Handle(), CL_TRUE, sizeof(left), sizeof(left), &left);
    return static_cast<std::size_t>(left);
  }

private:
  static std::size_t BytesOfPacket(const MarchMedium& medium, const MarchSums& target, int channels)
  {
    cl::Kernel size = MarchKernel(medium, target, channels, Define("TURNS", 1), "size_packet").kernel;
    const Buffer<cl_int> bytes(medium.device, 1, "size of a packet");
    medium.Launch(With(size, bytes), cl::NDRange(1));
    return static_cast<std::size_t>(bytes.Read().front());
  }

  const PhotonsOnDevice& Photons;
  std::size_t Packets;
  MarchKernel March;
  Buffer<cl_uchar> States;
  Buffer<cl_int> Going;
  Buffer<cl_int> Counters;
};

void AddTimes(const cl::Event& marched, const std::array<cl::Event, 2>& meanwhile, TurnTimes& times)
{
  const Span marching = SpanOf(marched, marched), beside = SpanOf(meanwhile[0], meanwhile[1]);
  times.meanwhile += beside.end - beside.begin;
  times.together += std::max(0.0, std::min(marching.end, beside.end) - std::max(marching.begin, beside.begin));
}
}

void MarchInTurns(const MarchMedium& medium, const PackedPhotons& packed, const PhotonsOnDevice& photons,
  const MarchSums& target, MarchTurns& turns,
  const std::function<const Buffer<float>&(const cl::CommandQueue& queue)>& show, const Monitor& monitor)
{
  TurnTimes& times = turns.times = {};
  const cl::CommandQueue mine = medium.device.AnotherQueue();
  const cl::CommandQueue theirs = turns.sideBySide ? medium.device.AnotherQueue() : mine;
  TurnsOfPhotons all(medium, photons, target, packed.channels);
  medium.device.Finish(); // wait for work queued earlier on the device's own queue
  TurnSchedule turn(turns.stretches, medium.EventLimit(), packed.Count());
  std::size_t left = packed.Count();
  for (; left > 0; ++times.turns)
  {
    turn.Next(left);
    const std::vector<cl::Event> marched = { all.Turn(mine, times.turns == 0, turn) };
    const bool besides = times.turns > 0; // in the first turn, there is no light to process yet
    const std::array<cl::Event, 2> meanwhile = besides ? turns.meanwhile(theirs) : std::array<cl::Event, 2>();
    theirs.enqueueBarrierWithWaitList(&marched);
    turns.take(theirs, show(theirs));
    theirs.finish();
    if (besides)
    {
      AddTimes(marched.front(), meanwhile, times);
    }
    const Span span = SpanOf(marched.front(), marched.front());
    times.marching += span.end - span.begin;
    left = all.StillGoing(mine);
    Report(monitor, 1.0 - static_cast<double>(left) / static_cast<double>(packed.Count()));
  }
}
}
