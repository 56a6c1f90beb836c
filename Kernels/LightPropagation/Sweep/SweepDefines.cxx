#include "LightPropagation/Sweep/SweepDefines.h"

#include "Device/Defines.h"

namespace tyndall
{
std::string DefinesOf(const SweepPlan& plan)
{
  return Define("REAL_WIDTH", plan.vector) + Define("CHANNELS", plan.channels) + Define("ROW", plan.row) +
    Define("CURRENTS", plan.partialCurrents) + Define("CHAIN_KEEPS", plan.rowsKept) +
    Define("OCTANT_SOURCE", plan.octantSource) + Define("ANGULAR", plan.angular != nullptr) +
    Define("BEAMS", plan.angular ? plan.angular->Beams() : 0);
}
}
