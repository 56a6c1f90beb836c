#pragma once

#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"
#include "LightPropagation/Sweep/OnGpu/PlaneKernels.h"

#include <array>

namespace tyndall
{
/// Light given or counted by cells of the box's faces (SweepRequest::faceIn, Deposit::faceOut) in a sweep on GPUs;
/// kernels in LaneFaces.cl. The sides of the planes of a batch's lanes are stored on the device: one float per ray,
/// plane and cell of the plane's edges, for entering and for leaving rays.
class LaneFaces
{
public:
  /// Arguments of `cross_plane` that describe how rays cross planes.
  struct Rays
  {
    const Buffer<SweepLane>& lanes;
    const Buffer<BundleInfo>& bundles;
    const Buffer<CrossingInfo>& crossings;
    bool ofRound = false;              ///< PlaneLaunch::ofRound; no light enters any more
    const Buffer<cl_float4>& entering; ///< incident light that is uniform over each face
  };

  /// @param lanes  must outlive this object
  /// @param request  has faceIn or faceOut
  LaneFaces(Device& device, const GpuLanes& lanes, const Grid& grid, const SweepRequest& request);

  bool Shine() const { return this->FaceIn != nullptr; }      ///< incident light is given by cells
  const Buffer<float>& In() const { return this->SidesIn; }   ///< sides of the planes: rays that enter
  const Buffer<float>& Out() const { return this->SidesOut; } ///< rays that leave

  /// Adds incident light to the maps where rays of an open axis start.
  /// @param first  index of the first channel's first value in faceIn and faceOut
  void EnterStart(const LaneBatch& batch, const Rays& rays, std::size_t first, const Buffer<float>& maps) const;
  /// Writes the incident light to the sides of the planes, before they are crossed.
  void EnterSides(const LaneBatch& batch, const Rays& rays, std::size_t first);
  /// Adds the power that left, from the sides of the planes that were crossed and from the maps at the ends of open
  /// axes, to faceOut. Lane by lane, so the order of summation does not depend on which lanes run concurrently.
  /// @param maps  rays before planes with even index, counted from where rays start, and with odd index
  void Leave(
    const LaneBatch& batch, const Rays& rays, std::size_t first, const std::array<const Buffer<float>*, 2>& maps) const;

private:
  LaneFaceInfo FacesOf(const SweepLane& lane, const Grid& grid) const;
  void LeaveSides(cl::Kernel& kernel, int lane, const Rays& rays, std::size_t first) const;
  void LeaveEnd(cl::Kernel& kernel, int lane, const Rays& rays, std::size_t first, const Buffer<float>& maps) const;
  cl::Kernel Kernel(const char* name) const;
  std::size_t CellsOfPlane(const SweepLane& lane) const;

  Device& TheDevice;
  const GpuLanes& The;
  const Buffer<float>*FaceIn, *FaceOut;
  bool Spreads;
  std::size_t Cells; ///< cells of all faces, per channel
  Buffer<LaneFaceInfo> Faces;
  Buffer<cl_int2> RayPlaces; ///< by ray of all lanes: the index of its bundle, and of the member in the bundle
  Buffer<float> SidesIn, SidesOut;
};
}
