#pragma once

#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepWorkspace.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <memory>

namespace tyndall
{
/// The sweep of a volume by one device, organised for GPUs: a work-item a voxel of a plane, all rays of one way along
/// an axis, and all ways along open axes at once where there is memory for it, both along a periodic one. Its light is
/// that of SweepInMemory to 1e-5, and the same bit for bit each time (numerics.md, section 4.8). A volume in host
/// memory goes through the device in slices, one way after the other (LaneSlices.h): the same light bit for bit along
/// open axes.
///
/// Memory: two floats a voxel of a plane, ray and channel; where ways go at once, each has its own path, flux and
/// partial currents, in at most a quarter of the memory that is left. Else they follow one another. With angular
/// moments a float more a voxel of a plane, ray and channel, what shines along it; a path is one of each function then.
/// Along a periodic axis a path is two floats, and maps stay from sweep to sweep. Where light comes or goes by cells of
/// the faces two floats more a ray, channel, plane and cell of the plane's edges. Of a volume in host memory all these,
/// and slots lie on the device.
class SweepOnGpu : public SweepOperator
{
public:
  /// Along the axes, there and back.
  enum class Ways
  {
    Automatic, ///< all at once where there is memory
    OneByOne
  };

  /// @param sigma_t  must stay
  /// @param request  no box of a grid with periodic axes
  /// @param workspace  must stay; shared by sweeps that never run at the same time
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
