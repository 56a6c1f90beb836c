#pragma once

#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"
#include "LightPropagation/Sweep/OnGpu/LaneFaces.h"
#include "LightPropagation/Sweep/OnGpu/LaneSums.h"
#include "LightPropagation/Sweep/OnGpu/PlaneKernels.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace tyndall
{
/// Sweep of a volume by one device, organised for GPUs: one work-item per voxel of a plane, for all rays of one way
/// along an axis. All ways along open axes run concurrently if memory allows, as do both ways along a periodic axis.
/// Agrees with SweepInMemory to 1e-5 and is reproducible bit for bit (numerics.md, section 4.8). A volume in host
/// memory is streamed through the device in slices, one way after the other (LaneSlices), with bitwise identical
/// results along open axes.
///
/// Device memory:
///  - maps: two floats per voxel of a plane, ray and channel; with angular moments one more, for the source along the
///    ray;
///  - if ways run concurrently, path, flux and partial currents of each way, in at most a quarter of the free memory
///    (if they do not fit, ways follow one another); with angular moments there is one path per function;
///  - along a periodic axis, paths take two floats and the maps are kept from sweep to sweep;
///  - if light is given or counted by cells of the faces, two floats per ray, channel, plane and cell of the plane's
///    edges.
///
/// For a volume in host memory all these and the slots are on the device.
class SweepOnGpu : public SweepByGroups
{
public:
  /// How the ways (forward and backward along each axis) are scheduled.
  enum class Ways
  {
    Automatic, ///< concurrently if memory allows
    OneByOne
  };

  /// @param sigma_t  must outlive the sweep
  /// @param request  must not restrict the sweep to a box if the grid has periodic axes
  /// @param workspace  must outlive the sweep; may be shared by sweeps that never run concurrently
  SweepOnGpu(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
    const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace,
    Ways ways = Ways::Automatic);

  void Forget() override { this->Forget({}); }

private:
  /// How the lanes of a batch cross planes.
  struct Crossing
  {
    bool shines;                                 ///< the medium has a source
    const Buffer<cl_float4>* entering;           ///< light incident on the sides
    const Buffer<CrossingInfo>* round = nullptr; ///< crossings of rays that wrap around; null: rays that start
  };
  /// Rays under way round a periodic axis between sweeps, for a batch and a group of channels.
  struct OnTheWay
  {
    Buffer<float> maps[2];
    int current = 0;
  };
  /// Incident light: the rays' power, as Entering, and the power by face.
  using Entered = std::pair<std::vector<cl_float4>, std::array<Rgb, 6>>;

  SweepTally ApplyGroup(
    std::size_t group, const SweepVolume& volume, const SweepBoundary& boundary, const Monitor& monitor) override;
  void MakeBuffers();
  void MakeSlices();
  Entered EnteredFrom(const SweepBoundary& boundary) const;
  bool Enter(const SweepBoundary& boundary, int group, SweepTally& tally);
  void CrossOnce(const LaneBatch& batch, const SweepVolume& volume, SweepTally& tally, const Monitor& monitor);
  void GoRound(const LaneBatch& batch, const SweepVolume& volume, SweepTally& tally, const Monitor& monitor);
  void BeginLost(const LaneBatch& batch);
  OnTheWay& RaysOnTheWay(const LaneBatch& batch, int group);
  void Forget(std::optional<int> group);
  bool ShineByCells() const { return this->Faces && this->Faces->Shine(); }
  LaneFaces::Rays RaysOf(const Crossing& how) const;
  PlaneLaunch LaunchOf(const LaneBatch& batch, const SweepVolume& volume) const;
  void StartRays(const LaneBatch& batch);
  int Cross(const LaneBatch& batch, const SweepVolume& volume, const Crossing& how,
    const std::array<const Buffer<float>*, 2>& maps, const Monitor& monitor);
  PlaneKernels::Size SizeOf(const LaneBatch& batch) const;
  VolumeArrays Arrays(const LaneBatch& batch, const SweepVolume& volume) const;
  void AddArrays(const LaneBatch& batch, const SweepVolume& volume);

  Device& TheDevice;
  SweepWorkspace& Workspace;
  GpuLanes The;

  std::vector<std::unique_ptr<LaneSlices>> Slices; ///< by lane, for a volume in host memory; null: swept in place
  Buffer<SweepLane> Lanes;
  Buffer<BundleInfo> Bundles;
  Buffer<CrossingInfo> Crossings;
  Buffer<float> Along;                            ///< GpuLanes::functions
  Buffer<float> Directed;                         ///< source in the rays' directions, laid out as maps
  Buffer<float> Maps[2];                          ///< maps of open axes
  std::map<std::pair<int, int>, OnTheWay> Rounds; ///< by a batch's first lane, and group
  /// [ray][channel] incident power, W: through u's, v's face, and where rays start
  Buffer<cl_float4> Entering;
  Buffer<cl_float4> Nothing; ///< zero incident power
  LaneArrays OfLanes;
  LanePowers Powers;
  std::optional<LaneFaces> Faces;      ///< if light is given or counted by cells
  std::map<int, Entered> KeptEntering; ///< cached incident light, by group
};
}
