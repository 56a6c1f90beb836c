#pragma once

#include "Device/Monitor.h"
#include "Photons/Marching/MarchLaunch.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace tyndall
{
/// How photons march a few voxels at a time, so that the light that they leave is used while they march on (Bernabei et
/// al., section III-A).
struct MarchTurns
{
  int stretches = 16; ///< of a photon's way in a turn, from voxel wall to voxel wall; 0: to its end
  /// Photons march on a queue of their own, beside what is done meanwhile; false: both take turns on one queue.
  bool sideBySide = true;
  /// Called first. @param channels  of the light that `take` will be given
  std::function<void(const PackedPhotons& photons, int channels)> begin;
  /// Queues what is done with the light of the turns before, and does not wait for it. Returns the first event and the
  /// last one.
  std::function<std::array<cl::Event, 2>(const cl::CommandQueue& queue)> meanwhile;
  /// Queues what takes over the light that photons have left since they began.
  /// @param fluence  W / length^2, [voxel][channel]
  std::function<void(const cl::CommandQueue& queue, const Buffer<float>& fluence)> take;
};

/// How far photons go in each turn: the last one takes them to their ends.
class TurnSchedule
{
public:
  /// @param each  stretches of a turn, as MarchTurns has them
  /// @param limit  walls and turns of a photon at most
  /// @param all  photons
  TurnSchedule(int each, int limit, std::size_t all)
    : Each(each)
    , Limit(limit)
    , All(all)
  {
  }

  /// The next turn. @param left  photons that are on their way still; where these are fewer than a hundredth it is the
  ///   last one
  void Next(std::size_t left);

  int stretches = 0;     ///< in this turn
  std::int64_t gone = 0; ///< stretches up to its end
  bool last = false;

private:
  int Each, Limit;
  std::size_t All;
};

/// How long that took, on the device.
struct TurnTimes
{
  int turns = 0;
  double marching = 0.0;  ///< s
  double meanwhile = 0.0; ///< s, of what was done beside photons that marched
  double together = 0.0;  ///< s, in which both were under way
};

/// March photons to their ends in turns.
/// @param show  queues what makes fluence of the sums so far
/// @throws DeviceError where packets of photons do not fit; Aborted: the sums are of a part of the ways then
TurnTimes MarchInTurns(const MarchMedium& medium, const PackedPhotons& packed, const PhotonsOnDevice& photons,
  const MarchSums& target, const MarchTurns& turns,
  const std::function<const Buffer<float>&(const cl::CommandQueue& queue)>& show, const Monitor& monitor);
}
