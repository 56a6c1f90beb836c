#pragma once

#include "LightPropagation/Sweep/OnGpu/GpuLanes.h"
#include "LightPropagation/Sweep/OnGpu/PlaneKernels.h"

#include <array>

namespace tyndall
{
/// Incident radiance and escaped power per cell of the box's faces (SweepRequest::faceIn, Deposit::faceOut) in a sweep
/// on GPUs; kernels in LaneFaces.cl. For planes that are crossed in the same launches, the device stores the power of
/// the rays that enter and leave sideways: two floats per ray, plane and cell of the plane's edges.
class LaneFaces
{
public:
  /// Arguments of the kernel `cross_plane` that describe the rays and their moves.
  struct Rays
  {
    const Buffer<SweepLane>& lanes;
    const Buffer<BundleInfo>& bundles;
    const Buffer<CrossingInfo>& crossings;
    bool ofRound = false; ///< PlaneLaunch::ofRound: rays wrap around a periodic axis, and no more light enters
    /// Power of incident rays, W, from light that is uniform over each face, [ray][channel] (PlaneRays::entering)
    const Buffer<cl_float4>& entering;
  };

  /// @param lanes  must outlive this object
  /// @param request  request that gives incident radiance or asks for escaped power per cell (faceIn, faceOut)
  LaneFaces(Device& device, const GpuLanes& lanes, const Grid& grid, const SweepRequest& request);

  bool Shine() const { return this->FaceIn != nullptr; } ///< whether incident radiance is given per cell
  /// Power of the rays that enter the planes sideways, W
  const Buffer<float>& In() const { return this->SidesIn; }
  /// Power of the rays that leave the planes sideways, W
  const Buffer<float>& Out() const { return this->SidesOut; }

  /// On open axes: adds to `maps` (power of each ray) the light incident through each cell of the faces where rays
  /// start.
  /// @param first  index of the first channel's first value in faceIn and faceOut
  void EnterStart(const LaneBatch& batch, const Rays& rays, std::size_t first, const Buffer<float>& maps) const;
  /// Computes the power of the rays that enter the planes sideways, from the light incident per cell. Call before the
  /// planes are crossed.
  void EnterSides(const LaneBatch& batch, const Rays& rays, std::size_t first);
  /// Adds to faceOut the power of the rays that left sideways from the planes just crossed and, on open axes, of the
  /// rays that left behind the last plane. Lanes are added one after another, so that the order of summation does not
  /// depend on which lanes run concurrently.
  /// @param maps  power of the rays before planes with even index, and before planes with odd index; planes are counted
  /// from where rays start
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
  std::size_t Cells; ///< number of cells of all faces, per channel
  Buffer<LaneFaceInfo> Faces;
  /// For each ray of all lanes: index of its bundle, and index of its direction (member) in the bundle.
  Buffer<cl_int2> RayPlaces;
  Buffer<float> SidesIn, SidesOut;
};
}
