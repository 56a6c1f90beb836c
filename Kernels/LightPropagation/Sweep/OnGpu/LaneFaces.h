#pragma once

#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"
#include "LightPropagation/Sweep/OnGpu/PlaneKernels.h"

#include <array>

namespace tyndall
{
/// Light that comes and goes by cells of the box's faces (SweepRequest::faceIn, Deposit::faceOut) in a sweep for GPUs:
/// LaneFaces.cl. What is beside the planes of a batch's lanes lies on the device, a float a ray, plane and cell of its
/// edges, in and out.
class LaneFaces
{
public:
  /// How rays cross planes: what a launch of `cross_plane` has of it.
  struct Rays
  {
    const Buffer<SweepLane>& lanes;
    const Buffer<BundleInfo>& bundles;
    const Buffer<CrossingInfo>& crossings;
    bool ofRound = false;              ///< PlaneLaunch::ofRound: nothing comes in any more
    const Buffer<cl_float4>& entering; ///< light that is the same for a whole face
  };

  /// @param lanes    must stay
  /// @param request  with faceIn or faceOut
  LaneFaces(Device& device, const GpuLanes& lanes, const Grid& grid, const SweepRequest& request);

  bool Shine() const { return this->In != nullptr; } ///< light comes in by cells
  void SetSides(PlaneKernels& planes) const;         ///< theirs, that are beside planes

  /// Into the maps where rays of an open axis start.
  /// @param first  where the first channel begins, of faceIn and faceOut
  void EnterStart(const LaneBatch& batch, const Rays& rays, std::size_t first, const Buffer<float>& maps) const;
  /// Beside planes that are then crossed.
  void EnterSides(const LaneBatch& batch, const Rays& rays, std::size_t first);
  /// From beside planes that were crossed, and from the maps at the ends of open axes: lane by lane, so that sums have
  /// one order whichever lanes go at once.
  /// @param maps  before planes of even numbers, counted from where rays start, and of odd ones
  void Leave(
    const LaneBatch& batch, const Rays& rays, std::size_t first, const std::array<const Buffer<float>*, 2>& maps) const;

private:
  LaneFaceInfo FacesOf(const SweepLane& lane, const Grid& grid) const;
  void LeaveSides(cl::Kernel& kernel, int lane, const Rays& rays, std::size_t first) const;
  void LeaveEnd(cl::Kernel& kernel, int lane, const Rays& rays, std::size_t first, const Buffer<float>& maps) const;
  cl::Kernel Kernel(const char* name, bool around) const;
  std::size_t CellsOfPlane(const SweepLane& lane) const;

  Device& TheDevice;
  const GpuLanes& The;
  const Buffer<float>*In, *Out;
  bool Spreads;
  std::size_t Cells; ///< of a channel
  Buffer<LaneFaceInfo> Faces;
  Buffer<cl_int2> RayPlaces; ///< of all lanes: the bundle, and which of its members it is
  Buffer<float> SidesIn, SidesOut;
};
}
