#pragma once

#include "Comparison/ComparedRun.h"

namespace tyndall
{
/// The runs of RunsOf, of one kind.
std::vector<ComparedRun> PhotonRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings);
}
