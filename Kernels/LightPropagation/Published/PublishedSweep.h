#pragma once

#include "LightPropagation/Published/PublishedPlan.h"
#include "LightPropagation/Published/PublishedVolumes.h"

#include "Device/Buffer.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Rays of the published algorithm on the device: a batch of directions goes through planes of the grid, all or those
/// that a rank has, and leaves what it deposits in the temporary buffers T; what is there is collected.
class PublishedSweep
{
public:
  using Batch = PublishedPlan::Batch;
  using Pass = PublishedPlan::Pass;

  /// @param volumes  need not be those that the calls below are given: of these the
  ///   channels, and whether there is colour, are the same, and the buffers that they need no larger than `sizes`
  /// @param cellsOfFaces  that are counted, 0: none are
  PublishedSweep(Device& device, const PublishedVolumes& volumes, const PublishedModel& model,
    const PropagationSettings& settings, const PublishedSizes& sizes, std::size_t cellsOfFaces);

  /// A batch is about to go.
  /// @param boundary  what enters, as PublishedBorders has it; empty: nothing, all orders but the first
  /// @param faceRadiance  that faces give back, as PublishedFaces has it; where cells are counted
  void Begin(const std::vector<float>& boundary, const std::vector<float>& faceRadiance);

  /// Where the rays of a pass come from and go to.
  struct Ends
  {
    bool given = false; ///< they start with what Carried[0] has
    bool kept = false;  ///< what they have in the end goes to Carried[1]
  };

  /// One ray a voxel of the map and direction, from the first plane to behind the last.
  /// @param emits   U is not zero
  /// @param report  is given the part of the pass that is done
  /// @return what left through the borders, laid out as PublishedPropagate.cl says
  std::vector<float> Send(const PublishedVolumes& volumes, const PublishedPlan& plan, const Batch& batch,
    const Pass& pass, const Ends& ends, bool emits, const std::function<void(double)>& report);

  bool CountsCells() const { return this->CellsOfFaces > 0; }
  /// By cells of faces, of all passes of the batch, laid out as PublishedFaces.cl says.
  std::vector<float> LeftThroughCells() const { return this->Left.Read(); }

  /// Adds the batch's T to the moments of the order.
  /// @param begins  the first batch of a layout: sets them
  void Collect(const PublishedVolumes& volumes, const PublishedPlan& plan, const Batch& batch, bool begins);

  Buffer<float> Contributions; ///< T
  Buffer<float> Carried[2];    ///< of the planes or the order before; for those after

private:
  void MakeKernels(const PublishedVolumes& volumes, const PublishedModel& model);
  PublishedMap Describe(
    const PublishedVolumes& volumes, const PublishedPlan& plan, const Batch& batch, const Ends& ends) const;
  PublishedFaceCells DescribeFaces(const PublishedPlan& plan, const Batch& batch) const;
  void CrossPlanes(const PublishedVolumes& volumes, const PublishedPlan& plan, const Batch& batch, const Pass& pass,
    const PublishedMap& info, bool emits, const std::function<void(double)>& report);
  void Enqueue(cl::Kernel& kernel, std::array<int, 3> global, std::array<int, 3> local);

  Device& TheDevice;
  std::array<bool, 3> Periodic;
  int Channels;
  std::size_t CellsOfFaces;
  Buffer<float> Rays, Escaped, Boundary;
  Buffer<float> FaceIn, Left; ///< radiance that faces give back; what leaves through their cells
  cl::Kernel StartRays, CrossVoxels[2], EndRays, AddDirections;
};
}
