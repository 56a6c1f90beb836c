#include "LightPropagation/Sweep/SweepDefines.h"

#include "Device/Defines.h"

namespace tyndall
{
namespace
{
constexpr int RowsTogether = 8; ///< of a plane with many moments: they stay in the cache for all bundles

std::string DefineMoments(const SweepPlan& plan)
{
  if (!plan.angular)
  {
    return Define("ANGULAR", 0) + Define("BEAMS", 0);
  }
  return Define("ANGULAR", 1) + Define("BEAMS", plan.angular->Beams()) +
    Define("MOMENTS_IN_PLACE", plan.momentsInPlace) + Define("TILE", RowsTogether);
}
}

std::string DefinesOf(const SweepPlan& plan)
{
  return Define("REAL_WIDTH", plan.vector) + Define("CHANNELS", plan.channels) + Define("ROW", plan.row) +
    Define("CURRENTS", plan.partialCurrents) + Define("CHAIN_KEEPS", plan.rowsKept) +
    Define("OCTANT_SOURCE", plan.octantSource) + DefineMoments(plan);
}
}
