#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Sweep/Slices/SlicePieces.h"
#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Sweep/SweepWorkspace.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// A volume in host memory that is swept through slots on the device (Gruson et al., section 4.2; numerics.md, section
/// 4.10): while the units cross the slices in their slots, those that they crossed before go back and those that they
/// come to next are fetched, by a second queue. The rays stay on the device.
///
/// Each unit has two slots. A slot holds a few planes of all arrays, each array [slot][part][z][y][x] with a slot's
/// extents, in buffers of the workspace.
class SliceStream
{
public:
  /// Null where the volume is not to be streamed: it lies on the device, or kernels work on host memory in place; or
  /// its planes along the axis cannot be told apart in memory (moments along x of boxes that are cut, or whose slabs
  /// do not end between groups of voxels). Then a sweep reads and adds to the arrays where they are.
  /// @param plan, workspace  must stay; the workspace has its maps and scratch
  static std::unique_ptr<SliceStream> Make(Device& device, const SweepPlan& plan, SweepWorkspace& workspace);

  SliceStream(Device& device, const SweepPlan& plan, SweepWorkspace& workspace, int thickness);

  int Thickness() const { return this->Extent[this->Plan.axes.axis]; } ///< planes of a slot

  /// Launches, cut into pieces, and as the kernel has them: [launch][ranges, slots][unit].
  struct Schedule
  {
    std::vector<std::vector<SlicePiece>> pieces;
    Buffer<cl_int2> rows;
  };
  Schedule Cut(const std::vector<cl_int2>& schedule) const;

  /// Where a unit's piece of a launch lies.
  struct SlotPlace
  {
    std::size_t slot;
    int firstPlane; ///< of the box, that the slot begins with
  };
  SlotPlace PlaceOf(const SlicePiece& piece, std::size_t launch, std::size_t unit) const;

  /// The launch's layout as that of slots.
  void Describe(SweepInfo& info) const;
  const Buffer<float>& Slots(SlotArray array) const;

  /// Queues a launch, which is to wait for some events, and to tell one when it is done.
  using Launch = std::function<void(int launch, const std::vector<cl::Event>* after, cl::Event* done)>;
  /// Runs all launches, with what they need around them. The device's queue goes on when all has come back.
  void Cross(const Schedule& schedule, const SweepVolume& volume, const Launch& launch);

private:
  /// A box of floats in two arrays, by rows.
  struct Rows
  {
    std::array<std::size_t, 3> count; ///< floats of a row, rows, layers
    std::size_t hostFirst, hostRow, hostLayer;
    std::size_t slotFirst, slotRow, slotLayer;
  };
  /// An array of the volume.
  struct Streamed
  {
    const Buffer<float>* host;
    SlotArray slots;
    int parts;         ///< [part][stride]
    std::size_t first; ///< of part 0, and of the angular moments of light
    bool comesBack;    ///< it is added to
    int beams = -1;    ///< of arrays with angular moments: how many; -1: of others
  };
  std::vector<Streamed> ArraysOf(const SweepVolume& volume) const;
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
  std::array<int, 3> Extent;      ///< of a slot, voxels
  std::size_t Stride = 0;         ///< of a part of a slot
  MomentPlaces Places = {};       ///< in a slot
  std::vector<cl::Event> Waiting; ///< for which the next transfer has to wait
  cl::Event Last;                 ///< of the last transfer
};
}
