#pragma once

#include "Device/Monitor.h"
#include "Photons/Marching/MarchRun.h"

#include <array>
#include <functional>

namespace tyndall
{
/// Device times, s, of a march in turns (launches that follow photons over a limited number of path segments).
struct TurnTimes
{
  int turns = 0;          ///< number of turns
  double marching = 0.0;  ///< time of the marching kernels
  double meanwhile = 0.0; ///< time of the work queued by MarchTurns::meanwhile
  double together = 0.0;  ///< time during which march and `meanwhile` were running concurrently
};

/// Callbacks of a march in turns: photons march a limited number of path segments per turn, and the light deposited
/// so far is processed while the next turn is running (Bernabei et al., section III-A).
struct MarchTurns
{
  /// Number of path segments of a photon per turn (from voxel wall to voxel wall); 0: one turn, to the photon's end.
  int stretches = 16;
  /// Whether photons march on a separate command queue, concurrently with `meanwhile`; false: one queue for both.
  bool sideBySide = true;
  /// Called once before the first turn.
  /// @param photons  the packed photons
  /// @param channels  number of channels of the fluence that `take` receives
  std::function<void(const PackedPhotons& photons, int channels)> begin;
  /// Queues the processing of the light of earlier turns, without waiting for it. Returns the events of the first and
  /// the last queued command.
  std::function<std::array<cl::Event, 2>(const cl::CommandQueue& queue)> meanwhile;
  /// Queues the transfer of the light accumulated since the march began.
  /// @param fluence  W / length^2, [voxel][channel]
  std::function<void(const cl::CommandQueue& queue, const Buffer<float>& fluence)> take;
  TurnTimes times; ///< output: device times of the march
};

/// Marches photons to their ends in turns (MarchTurns).
/// @param show  queues the conversion of the sums accumulated so far to fluence
/// @throws DeviceError if the states of the photons do not fit into the device's memory; Aborted: the sums then hold
///   only a part of the paths
void MarchInTurns(const MarchMedium& medium, const PackedPhotons& packed, const PhotonsOnDevice& photons,
  const MarchSums& target, MarchTurns& turns,
  const std::function<const Buffer<float>&(const cl::CommandQueue& queue)>& show, const Monitor& monitor);
}
