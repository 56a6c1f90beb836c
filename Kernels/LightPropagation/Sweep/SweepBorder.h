#pragma once

#include "LightPropagation/Sweep/SweepPlan.h"
#include "LightPropagation/Sweep/SweepTally.h"

#include <vector>

namespace tyndall
{
/// The light that comes in through the box's faces in a sweep, as the sweep's buffers take it: each holds both ways,
/// forward first.
class SweepBorder
{
public:
  /// What it is made for.
  enum class Holds
  {
    Maps,     ///< all but `rays`
    RaysAlone ///< `rays` and `powerIn`
  };

  /// @param plan  must stay
  /// @param boundary  not empty
  SweepBorder(const SweepPlan& plan, const SweepBoundary& boundary, Holds holds = Holds::Maps);

  /// W of each ray, [way][bundle][member][channel]: that comes in through u's face, through v's, and where it starts.
  std::vector<cl_float4> rays;

  /// Power that rays start with; in the columns beside, that of those that come in through u's faces.
  std::vector<float> maps;
  std::vector<float> outside;      ///< of those that come in through v's faces: [bundle][member][channel][row]
  std::vector<float> radiance;     ///< of those that come in through u's faces: [bundle][member][channel]
  std::array<Rgb, 6> powerIn = {}; ///< W by face

private:
  /// Voxels that a bundle's rays move aside over all planes, in its own frame.
  struct Moves
  {
    double u = 0.0, v = 0.0;
  };
  Moves MovesOf(const Bundle& bundle) const;
  void EnterMember(const SweepBoundary& boundary, std::size_t bundle, int way, int member, const Moves& moves);
  Rgb PowerOfRay(const SweepBoundary& boundary, const Bundle& bundle, int direction, int face) const;
  void Write(std::size_t bundle, int way, int slot, float fromU, float fromV, float fromP);

  const SweepPlan& Plan;
};
}
