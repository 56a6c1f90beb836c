#pragma once

#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// Planes of the box that one unit of work (rays carried by one work-item) crosses in one launch, all of them in one
/// slot (a device buffer for a few planes).
struct SlicePiece
{
  /// First and end plane, counted from the plane where rays start, as in SweepPlan::schedule
  cl_int2 range = { { 0, 0 } };
  /// The planes of `range` as indices in the box, [begin, end); empty: the unit of work is idle in this launch
  int begin = 0, end = 0;
};

/// Streams a volume in host memory through slots on the device during a sweep (Gruson et al. 2012, section 4.2;
/// numerics.md, section 4.10). While the units of work (rays carried by one work-item each) cross the slices in their
/// slots, a second queue copies the previous slices back to the host and fetches the next ones. The rays stay on the
/// device.
///
/// Each unit of work has two slots. A slot holds a few planes of every array, [slot][part][z][y][x] with the slot's
/// extents, in buffers of the workspace.
class SliceStream
{
public:
  /// Returns null if the volume is not streamed, so that the sweep accesses its arrays in place. A volume is not
  /// streamed if it is in device memory, if the kernels work on host memory in place, or if planes along x cannot be
  /// copied separately. Angular moments are stored in groups of neighbouring voxels along x. They cannot be copied
  /// plane by plane if only a part of the grid is swept along y, or if units of work in the same launch would share a
  /// group.
  /// @param plan, workspace  must outlive this object; maps and scratch of the workspace are already allocated
  static std::unique_ptr<SliceStream> Make(Device& device, const SweepPlan& plan, SweepWorkspace& workspace);

  SliceStream(Device& device, const SweepPlan& plan, SweepWorkspace& workspace, int thickness);

  int Thickness() const { return this->Extent[this->Plan.axes.axis]; } ///< number of planes that a slot holds

  /// Launches of the sweep. If the volume is streamed, they are cut into pieces whose planes fit in a slot.
  struct Schedule
  {
    /// Planes that each unit of work crosses in each launch, [launch][unit of work]; empty: not streamed
    std::vector<std::vector<SlicePiece>> pieces;
    /// Argument `schedule` of the kernel `sweep`, [launch][unit of work]: first and end plane that each unit of work
    /// (rays carried by one work-item) crosses. If streamed, each launch has a second list [unit of work]: the slot,
    /// and the index in the box of the slot's first plane
    Buffer<cl_int2> rows;
  };
  Schedule Cut(const std::vector<cl_int2>& schedule) const;

  /// Slot that holds the planes that a unit of work crosses in a launch.
  struct SlotPlace
  {
    std::size_t slot;
    int firstPlane; ///< index in the box of the slot's first plane
  };
  SlotPlace PlaceOf(const SlicePiece& piece, std::size_t launch, std::size_t unit) const;

  /// Replaces the memory layout of the volume in `info` by that of the slots (device buffers for a few planes).
  void Describe(SweepInfo& info) const;
  VolumeArrays Arrays() const; ///< device arrays of the slots

  /// Function that queues the kernel of one launch, which waits for the events `after` (null: none) and signals `done`.
  using Launch = std::function<void(int launch, const std::vector<cl::Event>* after, cl::Event* done)>;
  /// Runs all launches and their transfers. Later commands in the device's queue wait until all results are on the
  /// host.
  void Cross(const Schedule& schedule, const SweepVolume& volume, const Launch& launch);

private:
  /// Location of a box of floats in a host array and in a slot, between which it is copied row by row.
  struct Rows
  {
    std::array<std::size_t, 3> count; ///< floats per row, rows per layer, layers
    std::size_t hostFirst, hostRow, hostLayer;
    std::size_t slotFirst, slotRow, slotLayer;
  };
  /// An array of the volume that is streamed.
  struct Streamed
  {
    const Buffer<float>* host;
    SlotArray slots;
    /// Number of parts, e.g. channels or components; the host array is [part][voxel]
    int parts;
    /// Index in the host array of the first float of part 0 (the first channel or component); the location of the
    /// angular moments follows from it
    std::size_t first;
    bool comesBack; ///< whether the sweep adds to the array, so that it must be copied back to the host
    /// Number of beams (sources with their own angular distribution), for arrays with angular moments; -1: an array
    /// without moments
    int beams = -1;
  };
  std::vector<Streamed> StreamedArrays(const SweepVolume& volume) const;
  const Buffer<float>& Slots(SlotArray array) const;
  void LaySlots();
  bool HasMoments() const { return this->Plan.angular != nullptr; }
  /// Number of neighbouring planes whose angular moments are interleaved in memory and so are copied together:
  /// MomentGroup if the marching axis is x, else 1.
  int Aligned() const { return this->HasMoments() && this->Plan.axes.axis == 0 ? MomentGroup : 1; }
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
  std::array<int, 3> Extent;      ///< extent of a slot, voxels
  std::size_t Stride = 0;         ///< number of floats from one part of a slot to the next
  MomentPlaces Places = {};       ///< memory layout of the moments in a slot
  std::vector<cl::Event> Waiting; ///< events that the next transfer must wait for
  cl::Event Last;                 ///< event of the last transfer
};
}
