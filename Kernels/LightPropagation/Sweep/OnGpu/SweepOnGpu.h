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
/// Sweep of a volume by one device, organised for GPUs: one work-item per voxel of a plane, for all rays that march in
/// one sense along an axis. Both senses of all open axes run concurrently if memory allows, as do both senses along a
/// periodic axis. Agrees with SweepInMemory to 1e-5 and is reproducible bit for bit (numerics.md, section 4.8). A
/// volume in host memory is streamed through the device in slices, one sense after another (LaneSlices), with bitwise
/// identical results along open axes.
///
/// Device memory:
///  - maps: two floats per voxel of a plane, ray and channel; with angular moments a third float, for the source along
///  the ray;
///  - if senses run concurrently, path, flux and partial currents of each sense, in at most a quarter of the free
///  memory (if they do not fit, senses run one after another); with angular moments there is one path per function;
///  - along a periodic axis, a path integral takes two floats, and the maps are kept from sweep to sweep;
///  - if light is given or summed per cell of the faces, two floats per ray, channel, plane and cell of the plane's
///  edges.
///
/// For a volume in host memory all these arrays and the slots are on the device.
class SweepOnGpu : public SweepByGroups
{
public:
  /// Schedule of the senses (forward and backward along each axis) of a sweep.
  enum class Ways
  {
    Automatic, ///< senses run concurrently if memory allows
    OneByOne
  };

  /// @param sigma_t  extinction, 1/length; must outlive the sweep
  /// @param request  must not restrict the sweep to a box if the grid has periodic axes
  /// @param workspace  must outlive the sweep; may be shared by sweeps that never run concurrently
  SweepOnGpu(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t,
    const std::array<bool, 3>& periodic, const SweepRequest& request, SweepWorkspace& workspace,
    Ways ways = Ways::Automatic);

  void Forget() override { this->Forget({}); }

private:
  /// Inputs for the crossing of all planes by a batch (lanes that run concurrently): sources, incident light and moves
  /// of the rays.
  struct Crossing
  {
    bool shines; ///< whether the medium has a source
    /// Power of each incident ray, W, in the layout of the buffer Entering
    const Buffer<cl_float4>* entering;
    /// Sideways moves of the rays in a further lap around a periodic axis; null: a lap in which rays start, whose moves
    /// are in the member Crossings
    const Buffer<CrossingInfo>* round = nullptr;
  };
  /// Rays in transit along a periodic axis between sweeps, for both senses along the axis and a group of channels.
  struct OnTheWay
  {
    Buffer<float> maps[2];
    int current = 0;
  };
  /// Incident light: power of each ray, W, in the layout of `Entering`, and power through each face of the box, W.
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

  /// Slices of a volume in host memory, streamed for each lane (rays of one sense along an axis); null: the lane sweeps
  /// the volume in place
  std::vector<std::unique_ptr<LaneSlices>> Slices;
  Buffer<SweepLane> Lanes;
  Buffer<BundleInfo> Bundles;
  Buffer<CrossingInfo> Crossings;
  Buffer<float> Along;    ///< values of the angular functions, GpuLanes::functions
  Buffer<float> Directed; ///< source in each ray's direction, W / (length^3 sr), in the layout of the maps
  /// Power of the rays of open axes, W, in the layout of SweepLane::map: before planes with even index, and before
  /// planes with odd index
  Buffer<float> Maps[2];
  /// Rays in transit along periodic axes; key: index of the batch's first lane, and index of the group of channels that
  /// are swept together
  std::map<std::pair<int, int>, OnTheWay> Rounds;
  /// Incident power of each ray, W, [ray][channel]: through the face normal to u, through the face normal to v, and
  /// where rays start
  Buffer<cl_float4> Entering;
  Buffer<cl_float4> Nothing; ///< zeros, in the layout of Entering: no incident light
  LaneArrays OfLanes;
  LanePowers Powers;
  std::optional<LaneFaces> Faces; ///< set if light is given or summed per cell of the faces
  /// Cached incident light; key: index of the group of channels that are swept together
  std::map<int, Entered> KeptEntering;
};
}
