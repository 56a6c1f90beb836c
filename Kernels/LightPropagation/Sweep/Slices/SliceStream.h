#pragma once

#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// Planes of the box that one unit crosses in one launch, all of them in one slot.
struct SlicePiece
{
  cl_int2 range = { { 0, 0 } }; ///< as in SweepPlan::schedule
  int begin = 0, end = 0;       ///< planes of the box, [begin, end); empty: the unit is idle in this launch
};

/// Streams a volume in host memory through slots on the device during a sweep (Gruson et al., section 4.2; numerics.md,
/// section 4.10). While the units cross the slices in their slots, a second queue copies the previous slices back to
/// the host and fetches the next ones. The rays stay on the device.
///
/// Each unit has two slots. A slot holds a few planes of every array, [slot][part][z][y][x] with the slot's extents, in
/// buffers of the workspace.
class SliceStream
{
public:
  /// Returns null if the volume is not streamed: because it lies on the device, because the kernels work on host memory
  /// in place, or because its planes along the axis are not separate in memory (moments along x, if the volume is swept
  /// in part or its slabs do not end between groups of voxels). The sweep then accesses the arrays in place.
  /// @param plan, workspace  must outlive this object; maps and scratch of the workspace are already allocated
  static std::unique_ptr<SliceStream> Make(Device& device, const SweepPlan& plan, SweepWorkspace& workspace);

  SliceStream(Device& device, const SweepPlan& plan, SweepWorkspace& workspace, int thickness);

  int Thickness() const { return this->Extent[this->Plan.axes.axis]; } ///< planes that a slot holds

  /// The sweep's launches, and the same cut into pieces if the volume is streamed.
  struct Schedule
  {
    std::vector<std::vector<SlicePiece>> pieces; ///< [launch][unit]; empty: the volume is not streamed
    Buffer<cl_int2>
      rows; ///< as the kernel reads it: [launch][unit] planes from, to; of pieces [launch][ranges, slots][unit]
  };
  Schedule Cut(const std::vector<cl_int2>& schedule) const;

  /// The slot that holds a unit's piece of a launch.
  struct SlotPlace
  {
    std::size_t slot;
    int firstPlane; ///< index in the box of the slot's first plane
  };
  SlotPlace PlaceOf(const SlicePiece& piece, std::size_t launch, std::size_t unit) const;

  /// Replaces the volume's memory layout in `info` by the slots' layout.
  void Describe(SweepInfo& info) const;
  VolumeArrays Arrays() const; ///< the slots

  /// Queues a launch that waits for the events `after` (null: for none) and signals `done`.
  using Launch = std::function<void(int launch, const std::vector<cl::Event>* after, cl::Event* done)>;
  /// Runs all launches with their transfers. The device's queue continues when all results are back on the host.
  void Cross(const Schedule& schedule, const SweepVolume& volume, const Launch& launch);

private:
  /// A box of floats to be copied between host array and slot array, row by row.
  struct Rows
  {
    std::array<std::size_t, 3> count; ///< floats per row, rows per layer, layers
    std::size_t hostFirst, hostRow, hostLayer;
    std::size_t slotFirst, slotRow, slotLayer;
  };
  /// An array of the volume.
  struct Streamed
  {
    const Buffer<float>* host;
    SlotArray slots;
    int parts;         ///< [part][stride]
    std::size_t first; ///< index of the first float of part 0, and of the angular moments
    bool comesBack;    ///< the sweep adds to it: copied back to the host
    int beams = -1;    ///< number of beams, for arrays with angular moments; -1: an array without moments
  };
  std::vector<Streamed> StreamedArrays(const SweepVolume& volume) const;
  const Buffer<float>& Slots(SlotArray array) const;
  void LaySlots();
  bool HasMoments() const { return this->Plan.angular != nullptr; }
  int Aligned() const;
  std::size_t SlotFloats(SlotArray array) const;
  Rows PlanarRows(const SlicePiece& piece) const;
  Rows MomentRows(const SlicePiece& piece) const;
  void Copy(const std::vector<Streamed>& arrays, const std::vector<SlicePiece>& launch, int parity, bool back);
  void CopyArray(const Streamed& array, const SlicePiece& piece, std::size_t slot, bool back);
  void CopyRows(const Streamed& array, const Rows& rows, std::size_t host, std::size_t slot, bool back);

  Device& TheDevice;
  const SweepPlan& Plan;
  SweepWorkspace& Workspace;
  cl::CommandQueue Transfers;
  std::array<int, 3> Extent;      ///< of a slot, in voxels
  std::size_t Stride = 0;         ///< floats from one part of a slot to the next
  MomentPlaces Places = {};       ///< layout of the moments in a slot
  std::vector<cl::Event> Waiting; ///< that the next transfer waits for
  cl::Event Last;                 ///< of the last transfer
};
}
