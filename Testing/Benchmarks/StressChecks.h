#pragma once

#include "StressSolvers.h"

#include <string>
#include <vector>

/// Whether an outcome is right, by all that is known of its scene.
namespace bench
{
/// Every claim that this case and this solver admit, with what was found.
/// @param twin  what the same solver gives for the case's twin; null where there is none
std::vector<StressCheck> CheckOutcome(
  const StressSolver& solver, const StressCase& stressCase, const StressOutcome& outcome, const StressOutcome* twin);

/// Whether the light of the turned scene is the turned light.
StressCheck CheckTurned(
  const StressCase& stressCase, const StressOutcome& outcome, const CubeTurn& turn, const StressOutcome& turned);

/// Whether a solver may refuse this case, in these words.
bool MayRefuse(const StressSolver& solver, const StressCase& stressCase, const std::string& error);
}
