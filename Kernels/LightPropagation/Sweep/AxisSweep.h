#pragma once

#include "Device/ExactValues.h"
#include "Device/Monitor.h"
#include "LightPropagation/Sweep/OnCpu/SweepKernel.h"
#include "LightPropagation/Sweep/Slices/SliceStream.h"
#include "LightPropagation/Sweep/SweepBorder.h"
#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include <array>
#include <map>
#include <memory>
#include <optional>

namespace tyndall
{
/// Sweep along one axis on a CPU: carries the rays of bundles (sets of symmetric directions, RayBundles.h) through a
/// volume and deposits the power that they lose. Propagation and collection are done in one pass (numerics.md, section
/// 4), without the buffer per direction that Gruson et al. (2012, section 4.1) need.
///
/// Memory: the maps hold the power of each ray, one float per voxel of a plane, direction, channel and sense of
/// marching (forward, backward); each work-item has scratch for a few planes. Both are in the workspace, except the
/// maps of a periodic axis, whose rays are kept from one sweep to the next.
class AxisSweep
{
public:
  /// @param volume  describes the grid, the channels and the kind of the deposit; its arrays are not accessed
  /// @param workspace  must outlive this object; enlarged as needed
  /// @param sameBoundary  whether the boundary source is the same in every sweep of a volume
  AxisSweep(Device& device, const SweepVolume& volume, const AxisBundles& rays, const std::array<bool, 3>& periodic,
    SweepWorkspace& workspace, bool sameBoundary);

  /// Starts one sweep through the volume, forward and backward. On an open axis, only queues the work; on a periodic
  /// axis, also waits for it.
  /// @param boundary  incident light; empty: none
  /// @param mostPlanes  maximum number of planes that rays cross along a periodic axis in this sweep; rays that are
  /// then still in transit are continued in the next sweep
  /// @param monitor  receives the completed fraction of this sweep, 0 to 1
  void Start(const SweepVolume& volume, const SweepBoundary& boundary, int mostPlanes, const Monitor& monitor);

  /// Discards the rays in transit along a periodic axis.
  void Forget();

  /// Waits for the end of the sweep begun by Start. @return incident power, escaped power, and power in transit, W
  SweepTally Finish();

private:
  /// Sources and incident light of a launch of the kernel `sweep`.
  struct Entry
  {
    bool source = false;    ///< whether the medium has a source (emission or scattered light)
    bool border = false;    ///< whether light is incident on the faces parallel to the marching axis
    bool byCells = false;   ///< whether incident radiance is also given per cell of the box's faces
    bool mapsEmpty = false; ///< whether the memory of the maps (power of each ray) is uninitialised
  };
  void Enter(const SweepBoundary& boundary, std::size_t firstChannel);
  void GoRound(const SweepVolume& volume, int mostPlanes, const Monitor& monitor);
  void Cross(const SweepVolume& volume, const Entry& entry, const Buffer<CrossingInfo>& crossings,
    const SliceStream::Schedule& schedule, double seconds, const Monitor& monitor);
  SliceStream::Schedule ScheduleOf(const std::vector<cl_int2>& ranges) const;
  FaceInfo Faces(std::size_t firstChannel, const Deposit& to) const;
  template <class... Arguments>
  void RunOnMaps(const char* kernel, const SweepVolume* volume, bool ofFarFaces, const cl::NDRange& range,
    const Arguments&... arguments);
  cl::NDRange RowsOfMaps() const;
  const cl::Buffer& CellsOf(const Deposit& to);
  void TakeFaceCells(const Deposit& to);
  bool IsPeriodic() const { return this->Plan.periodic[this->Plan.axes.axis]; }
  /// Maps: power of each ray, W, in the layout of SweepBorder::maps.
  Buffer<float>& Maps() { return this->IsPeriodic() ? this->OwnMaps : this->Workspace.maps; }
  void SumMaps();
  std::array<Rgb, 2> PowerInMaps() const;
  Rgb PowerOnTheWay();

  Device& TheDevice;
  const SweepPlan Plan;
  SweepWorkspace& Workspace;
  const bool SameBoundary;
  SweepKernel Kernel;

  Buffer<float> OwnMaps; ///< power of the rays of a periodic axis, W; unused on an open axis
  /// Escaped power per cell of the box's faces, W, [work-item][channel][cell]; one array [channel][cell] if all
  /// work-items share the cells.
  std::optional<ExactValues> FaceCells;
  /// Power of the rays, W, summed over each row of the maps, [sense of marching][bundle][row][channel].
  Buffer<float> Sums;
  Buffer<BundleInfo> Bundles;
  Buffer<CrossingInfo> FirstCrossings;
  /// Copies slices of a volume in host memory to the device; null: the volume is in device memory
  std::unique_ptr<SliceStream> Stream;
  /// Ranges of planes that work-items cross in each launch of the kernel. `First`: in the laps in which rays start;
  /// `Rounds`: in further laps around a periodic axis
  SliceStream::Schedule First, Rounds;

  /// Cached incident light of each group of channels that are swept together; key: index of the group's first value in
  /// arrays over voxels (SweepVolume::first)
  std::map<std::size_t, std::unique_ptr<SweepBorder>> Borders;
  bool Dark = false; ///< whether the current sweep has neither a source nor incident light
  SweepTally Tally;  ///< incident and escaped power of the current sweep
};
}
