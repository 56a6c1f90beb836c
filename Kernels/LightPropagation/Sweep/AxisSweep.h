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
/// Sweep along one axis: carries all rays of a set of bundles through a volume and deposits the power they lose.
/// Propagation and collection are done in one pass, without a buffer per direction (Gruson et al. need one, their
/// section 4.1; numerics.md, section 4).
///
/// Memory: one float per voxel of a plane, direction, channel and way for the maps, and a few planes of scratch per
/// unit. Both are in the workspace, except the maps of a periodic axis, whose rays are kept from one sweep to the next.
class AxisSweep
{
public:
  /// @param volume  its grid, its channels and the presence of a flux are used
  /// @param workspace  must outlive this object; enlarged as needed
  /// @param sameBoundary  the boundary is the same in every sweep of a volume
  AxisSweep(Device& device, const SweepVolume& volume, const AxisBundles& rays, const std::array<bool, 3>& periodic,
    SweepWorkspace& workspace, bool sameBoundary);

  /// Starts one sweep through the volume, both ways. Queues the work; on an open axis it returns without waiting.
  /// @param boundary  incident light; empty: none
  /// @param mostPlanes  most planes that rays cross on a periodic axis before they wait for the next sweep
  /// @param monitor  receives the fraction of this sweep that is done
  void Start(const SweepVolume& volume, const SweepBoundary& boundary, int mostPlanes, const Monitor& monitor);

  /// Discards the rays that are still under way round a periodic axis.
  void Forget();

  /// Waits for the sweep that was started.
  SweepTally Finish();

private:
  /// Which sources and boundary light a launch has.
  struct Entry
  {
    bool source = false;    ///< the medium has a source
    bool border = false;    ///< light is incident on the faces that rays pass sideways
    bool byCells = false;   ///< that light is given by cells
    bool mapsEmpty = false; ///< the maps' memory is uninitialised
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
  /// Ray maps, laid out as in SweepBorder.
  Buffer<float>& Maps() { return this->IsPeriodic() ? this->OwnMaps : this->Workspace.maps; }
  void SumMaps();
  std::array<Rgb, 2> PowerInMaps() const;
  Rgb PowerOnTheWay();

  Device& TheDevice;
  const SweepPlan Plan;
  SweepWorkspace& Workspace;
  const bool SameBoundary;
  SweepKernel Kernel;

  Buffer<float> OwnMaps;                ///< maps of a periodic axis
  std::optional<ExactValues> FaceCells; ///< escaped power by cell, as Deposit::faceOut: [unit][channel][cell]
  Buffer<float> Sums;                   ///< power in the maps: [way][bundle][row][channel]
  Buffer<BundleInfo> Bundles;
  Buffer<CrossingInfo> FirstCrossings;
  std::unique_ptr<SliceStream> Stream; ///< for a volume in host memory; null: it is swept in place
  SliceStream::Schedule First, Rounds; ///< of rays that start, and of rays that wrap around

  std::map<std::size_t, std::unique_ptr<SweepBorder>> Borders; ///< by SweepVolume::first
  bool Dark = false;                                           ///< the current sweep has no light to carry
  SweepTally Tally;                                            ///< of the current sweep
};
}
