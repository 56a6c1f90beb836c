#pragma once

#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/TransportParts.h"

#include <memory>
#include <vector>

namespace tyndall
{
using UncollidedSources = std::vector<std::unique_ptr<UncollidedSource>>;

UncollidedSources LampsOf(const TransportParts& parts);
UncollidedSources BrightEmissionOf(const TransportParts& parts);

/// All that the medium emits, however it is carried.
void CountEmission(const TransportParts& parts, EnergyLedger& ledger);

/// How far a solve is, 0 to 1. Iterations are counted where their number is known, else the logarithm of the residual tells.
/// @param iterations  done, the one that is under way in part
double ProgressOf(const PropagationSettings& settings, double residual, double iterations);
}
