#pragma once

#include "LightPropagation/Published/PublishedPlan.h"
#include "LightPropagation/Published/PublishedVolumes.h"
#include "LightPropagation/Sweep/SweepTally.h"

#include "Device/Buffer.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Ray propagation of the published algorithm on the device: the rays of a batch of directions cross the grid and write
/// their deposits to the temporary buffers T, which are then collected into the moments of the order.
class PublishedSweep
{
public:
  using Batch = PublishedPlan::Batch;
  using Pass = PublishedPlan::Pass;

  /// @param volumes, plan, model  must outlive this
  PublishedSweep(Device& device, const PublishedVolumes& volumes, const PublishedPlan& plan,
    const PublishedModel& model, const PropagationSettings& settings);

  /// Prepares a batch.
  /// @param incident  boundary light is incident (first order only), and counted in `tally`
  void Begin(const Batch& batch, bool incident, SweepTally& tally);

  /// Traces one ray per map voxel and direction, from the first plane to beyond the last.
  /// @param emits   U is not zero
  /// @param report  receives the fraction of the pass that is done
  void Send(
    const Batch& batch, const Pass& pass, bool emits, SweepTally& tally, const std::function<void(double)>& report);

  /// Adds T of the batch to the moments of the order.
  /// @param begins  first batch of a layout: overwrites the moments
  void Collect(const Batch& batch, bool begins);

  Buffer<float> Contributions; ///< T

private:
  void MakeKernels();
  PublishedMap Describe(const Batch& batch) const;
  std::vector<float> IncidentRadiance(const Batch& batch) const;
  void TallyIncident(const Batch& batch, SweepTally& tally) const;
  void TallyEscaped(const Batch& batch, SweepTally& tally) const;
  void CrossPlanes(const Batch& batch, const Pass& pass, const PublishedMap& info, bool emits,
    const std::function<void(double)>& report);
  void Enqueue(cl::Kernel& kernel, std::array<int, 3> global, std::array<int, 3> local);

  Device& TheDevice;
  const PublishedVolumes& Volumes;
  const PublishedPlan& Plan;
  const PublishedModel& Model;
  std::array<bool, 3> Periodic;
  int Channels;
  Buffer<float> Rays, Escaped, Boundary;
  Buffer<float> Carried; ///< radiance that wraps around periodic axes into the next order
  cl::Kernel StartRays, CrossVoxels[2], EndRays, AddDirections;
};
}
