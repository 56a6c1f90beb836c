#pragma once

#include "LightPropagation/Sweep/SweepPlan.h"

#include <vector>

namespace tyndall
{
/// Sideways moves of a bundle's rays over several planes, voxels, in the bundle's own frame: along u, along v.
std::array<double, 2> SidewaysMoves(const Bundle& bundle, int firstPlane, int planes);

/// Adds power that left sideways to a tally.
/// @param left  W, [any][-u, +u, -v, +v][channel]
void CountSideways(const SweepPlan& plan, const std::vector<float>& left, SweepTally& tally);

/// Incident light of a sweep, in the layout of the sweep's buffers. Each buffer holds both ways, forward first.
class SweepBorder
{
public:
  /// Which members are filled.
  enum class Holds
  {
    Maps,     ///< all except `rays`
    RaysAlone ///< only `rays` and `powerIn`
  };

  /// @param plan  must outlive this object
  /// @param boundary  not empty
  SweepBorder(const SweepPlan& plan, const SweepBoundary& boundary, Holds holds = Holds::Maps);

  /// Incident power of each ray, W, [way][bundle][member][channel]; components: through u's face, through v's face, at
  /// the ray's start.
  std::vector<cl_float4> rays;

  /// Initial power of the rays, W; the columns beside the plane hold the power of rays that enter through u's faces.
  std::vector<float> maps;
  std::vector<float> outside;      ///< power of rays that enter through v's faces, [bundle][member][channel][row]
  std::vector<float> radiance;     ///< power of rays that enter through u's faces, [bundle][member][channel]
  std::array<Rgb, 6> powerIn = {}; ///< incident power by face, W

private:
  void EnterMember(
    const SweepBoundary& boundary, std::size_t bundle, int way, int member, const std::array<double, 2>& moves);
  Rgb PowerOfRay(const SweepBoundary& boundary, const Bundle& bundle, int direction, int face) const;
  void Write(std::size_t bundle, int way, int slot, float fromU, float fromV, float fromP);

  const SweepPlan& Plan;
};
}
