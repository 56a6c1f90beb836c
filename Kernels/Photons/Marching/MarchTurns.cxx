#include "Photons/Marching/MarchTurns.h"

#include "Device/Defines.h"
#include "Device/GroupSize.h"
#include "Device/Sizes.h"

#include <algorithm>
#include <vector>

namespace tyndall
{
namespace
{
struct Span
{
  double begin = 0.0, end = 0.0; ///< s
};

Span SpanOf(const cl::Event& first, const cl::Event& last)
{
  return { 1e-9 * static_cast<double>(first.getProfilingInfo<CL_PROFILING_COMMAND_START>()),
    1e-9 * static_cast<double>(last.getProfilingInfo<CL_PROFILING_COMMAND_END>()) };
}

/// State of the photons between turns, and the arguments of their kernel.
class TurnsOfPhotons
{
public:
  TurnsOfPhotons(
    const MarchMedium& medium, const PackedPhotons& packed, const PhotonsOnDevice& photons, const MarchSums& target)
    : Medium(medium)
    , Photons(photons)
    , Target(target)
    , Count(packed.Count())
    , PacketCount(PartsOf(packed.Count(), static_cast<std::size_t>(medium.device.KernelWidth())))
    , March(MarchKernelFor(medium, target, packed.channels, "march_turn", Define("TURNS", 1)))
    , None(medium.device, 0, "cells of the voxels")
    , Packets(medium.device, this->PacketCount * this->BytesOfPacket(packed.channels), "photons on their way")
    , Going(medium.device, this->PacketCount, "photons on their way")
    , Left(medium.device, 1, "number of photons on their way")
    , Next(medium.device, 1, "number of the next photon")
  {
  }

  /// Queues a turn. @param stretches  path segments, at most the medium's limit
  cl::Event Turn(const cl::CommandQueue& queue, int turn, int stretches, bool last);
  /// Waits for the queue, then returns the number of photons that have not ended.
  std::size_t StillGoing(const cl::CommandQueue& queue) const
  {
    cl_int left = 0;
    queue.enqueueReadBuffer(this->Left.Handle(), CL_TRUE, 0, sizeof(left), &left);
    return static_cast<std::size_t>(left);
  }

private:
  std::size_t BytesOfPacket(int channels) const
  {
    cl::Kernel size = MarchKernelFor(this->Medium, this->Target, channels, "size_packet", Define("TURNS", 1));
    const Buffer<cl_int> bytes(this->Medium.device, 1, "size of a packet");
    this->Medium.Launch(With(size, bytes), cl::NDRange(1));
    return static_cast<std::size_t>(bytes.Read().front());
  }

  const MarchMedium& Medium;
  const PhotonsOnDevice& Photons;
  const MarchSums& Target;
  std::size_t Count, PacketCount;
  cl::Kernel March;
  Buffer<cl_int> None;
  Buffer<cl_uchar> Packets;
  Buffer<cl_int> Going, Left, Next;
};

cl::Event TurnsOfPhotons::Turn(const cl::CommandQueue& queue, int turn, int stretches, bool last)
{
  const MarchShares& shares = this->Target.shares;
  const std::size_t stride =
    shares.copies > 1 ? this->Target.records * static_cast<std::size_t>(this->Target.numbers) : 0;
  queue.enqueueFillBuffer(this->Left.Handle(), cl_int(0), 0, sizeof(cl_int));
  queue.enqueueFillBuffer(this->Next.Handle(), cl_int(0), 0, sizeof(cl_int));
  With(this->March, this->Medium.Describe(), this->Medium.sigma, this->Medium.coefficients, this->Medium.nodes,
    this->Photons.values, this->Photons.marks, this->None, this->Photons.ends, *this->Target.sums, cl_ulong(stride),
    this->Packets, this->Going, this->Left, this->Next, cl_int(this->Count), cl_int(turn), cl_int(stretches),
    cl_int(last));
  const bool workers = shares.workers > 0;
  cl::Event marched;
  queue.enqueueNDRangeKernel(this->March, cl::NullRange,
    cl::NDRange(workers ? static_cast<std::size_t>(shares.workers) : this->PacketCount),
    workers ? cl::NDRange(1) : GroupOfLargeItems(this->Medium.device), nullptr, &marched);
  queue.flush();
  return marched;
}

void AddTimes(const cl::Event& marched, const std::array<cl::Event, 2>& meanwhile, TurnTimes& times)
{
  const Span marching = SpanOf(marched, marched), beside = SpanOf(meanwhile[0], meanwhile[1]);
  times.meanwhile += beside.end - beside.begin;
  times.together += std::max(0.0, std::min(marching.end, beside.end) - std::max(marching.begin, beside.begin));
}
}

void TurnSchedule::Next(std::size_t left)
{
  constexpr std::size_t few = 100;
  const double before = static_cast<double>(this->gone);
  this->last = this->Each == 0 || left < this->All / few || before + this->Each >= static_cast<double>(this->Limit);
  this->stretches = this->last ? this->Limit : this->Each;
  this->gone += this->stretches;
}

TurnTimes MarchInTurns(const MarchMedium& medium, const PackedPhotons& packed, const PhotonsOnDevice& photons,
  const MarchSums& target, const MarchTurns& turns,
  const std::function<const Buffer<float>&(const cl::CommandQueue& queue)>& show, const Monitor& monitor)
{
  TurnTimes times;
  const cl::CommandQueue mine = medium.device.AnotherQueue();
  const cl::CommandQueue theirs = turns.sideBySide ? medium.device.AnotherQueue() : mine;
  TurnsOfPhotons all(medium, packed, photons, target);
  medium.device.Finish(); // work on the device's own queue
  TurnSchedule turn(turns.stretches, medium.EventLimit(), packed.Count());
  std::size_t left = packed.Count();
  for (; left > 0; ++times.turns)
  {
    turn.Next(left);
    const std::vector<cl::Event> marched = { all.Turn(mine, times.turns, turn.stretches, turn.last) };
    const bool besides = times.turns > 0; // the first turn has no light to process
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
  return times;
}
}
