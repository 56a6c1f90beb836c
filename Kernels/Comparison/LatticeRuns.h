#pragma once

#include "Comparison/ComparedRun.h"

namespace tyndall
{
/// The lattice runs of RunsOf; empty if no compared grid has cubic voxels.
std::vector<ComparedRun> LatticeRunsOf(Device& device, const ComparedScene& scene, const ComparedSettings& settings);
}
