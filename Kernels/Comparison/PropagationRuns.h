#pragma once

#include "Comparison/ComparedRun.h"

namespace tyndall
{
/// The light propagation runs of RunsOf.
std::vector<ComparedRun> PropagationRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings);
}
