#pragma once

#include "Comparison/ComparedRun.h"

namespace tyndall
{
/// The photon runs of RunsOf.
std::vector<ComparedRun> PhotonRunsOf(
  ComparedMethod method, Device& device, const ComparedScene& scene, const ComparedSettings& settings);
}
