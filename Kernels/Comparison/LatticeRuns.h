#pragma once

#include "Comparison/ComparedRun.h"

namespace tyndall
{
/// The runs of RunsOf on lattices; none where no grid that is tried has voxels that are cubes.
std::vector<ComparedRun> LatticeRunsOf(Device& device, const ComparedScene& scene, const ComparedSettings& settings);
}
