#pragma once

#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepWorkspace.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <memory>

namespace tyndall
{
/// Sweep of a volume by one device, organised for GPUs: one work-item per voxel of a plane, for all rays of one way
/// along an axis. All ways along open axes run concurrently if memory allows, as do both ways along a periodic axis.
/// Agrees with SweepInMemory to 1e-5 and is reproducible bit for bit (numerics.md, section 4.8). A volume in host
/// memory is streamed through the device in slices, one way after the other (LaneSlices.h), with bitwise identical
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
class SweepOnGpu : public SweepOperator
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
  ~SweepOnGpu() override;

  SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) override;
  void Forget() override;

private:
  class Implementation;
  std::unique_ptr<Implementation> Inner;
};
}
