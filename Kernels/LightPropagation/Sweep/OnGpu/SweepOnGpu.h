#pragma once

#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/VolumeLayout.h"

#include <array>
#include <memory>

namespace tyndall
{
/// The sweep of a volume in one device's memory, organised for GPUs: a work-item a voxel of a plane, all rays of one
/// way along an axis, and all six ways at once where there is memory for it. Its light is that of SweepInMemory to
/// 1e-5, and the same bit for bit each time (numerics.md, section 4.8).
///
/// Memory: two floats a voxel of a plane, ray and channel; where ways go at once, each has its own path, flux and
/// partial currents, in at most a quarter of the memory that is left. Else they follow one another. With angular moments
/// a float more a voxel of a plane, ray and channel, what shines along it; a path is one of each function then.
class SweepOnGpu : public SweepOperator
{
public:
  /// Whether it can do what is asked for: no periodic axis, no light by cells of the faces.
  /// SweepInMemory can, on GPUs too.
  static bool Can(const SweepRequest& request, const std::array<bool, 3>& periodic);

  /// Along the axes, there and back.
  enum class Ways
  {
    Automatic, ///< all at once where there is memory
    OneByOne
  };

  /// @param sigma_t  must stay
  /// @param request  what Can was true of
  SweepOnGpu(Device& device, const VolumeLayout& layout, const Buffer<float>& sigma_t, const SweepRequest& request,
    Ways ways = Ways::Automatic);
  ~SweepOnGpu() override;

  SweepTally Apply(const Buffer<float>* source, const SweepBoundary& boundary, const Monitor& monitor) override;
  void Forget() override {} ///< no ray goes round

private:
  class Implementation;
  std::unique_ptr<Implementation> Inner;
};
}
