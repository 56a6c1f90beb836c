#pragma once

#include "LightPropagation/Sweep/SweepPlan.h"

#include <vector>

namespace tyndall
{
/// Number of voxels that a bundle's rays move sideways, along the u and v axes of the bundle, while they cross `planes`
/// planes from plane `firstPlane` on.
std::array<double, 2> SidewaysMoves(const Bundle& bundle, int firstPlane, int planes);

/// Adds power that escaped through the faces parallel to the marching axis to SweepTally::out.
/// @param left  escaped power, W, as consecutive arrays [-u, +u, -v, +v][channel], which are summed
void CountSideways(const SweepPlan& plan, const std::vector<float>& left, SweepTally& tally);

/// Incident light of a sweep along one axis, in the layout of the sweep's buffers. Each array has values for both
/// senses of marching, forward first.
class SweepBorder
{
public:
  /// Selection of the arrays that the constructor fills.
  enum class Holds
  {
    Maps,     ///< all arrays except `rays`
    RaysAlone ///< only `rays` and `powerIn`
  };

  /// @param plan  must outlive this object
  /// @param boundary  incident radiance; not empty
  SweepBorder(const SweepPlan& plan, const SweepBoundary& boundary, Holds holds = Holds::Maps);

  /// Incident power of a ray, W, [sense][bundle][member (direction)][channel]; the components x, y and z are its power
  /// if it enters through the face normal to u, through the face normal to v, and at the face where rays start.
  std::vector<cl_float4> rays;

  /// Power of each ray before it crosses the first plane, W, in the layout of a sweep's maps (MapsInfo in
  /// SweepShared.h: rows of rays per bundle, direction and channel); the columns beyond the end of a row hold the
  /// power of rays that enter through the faces normal to u.
  std::vector<float> maps;
  /// Power of rays that enter through the faces normal to v, W, [bundle][member (direction)][channel][row]
  std::vector<float> outside;
  /// Power of a ray that enters through a face normal to u, W, [bundle][member (direction)][channel]
  std::vector<float> radiance;
  std::array<Rgb, 6> powerIn = {}; ///< incident power through each face of the box, W

private:
  void EnterMember(
    const SweepBoundary& boundary, std::size_t bundle, int way, int member, const std::array<double, 2>& moves);
  Rgb PowerOfRay(const SweepBoundary& boundary, const Bundle& bundle, int direction, int face) const;
  void Write(std::size_t bundle, int way, int slot, float fromU, float fromV, float fromP);

  const SweepPlan& Plan;
};
}
