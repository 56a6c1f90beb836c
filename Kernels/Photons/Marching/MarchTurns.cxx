#include "Photons/Marching/MarchRun.h"

#include "Device/Device.h"
#include "Device/Sizes.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace tyndall
{
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
