#pragma once

#include "Comparison/ComparedRun.h"

/// The runs of RunsOf by their kinds.
namespace tyndall
{
std::vector<ComparedRun> PropagationRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings);
std::vector<ComparedRun> PhotonRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings);
}
