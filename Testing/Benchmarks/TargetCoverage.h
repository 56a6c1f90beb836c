#pragma once

#include "Device/Device.h"

#include <string>

namespace bench
{
/// How often the errors that solvers estimate cover their true errors, over CoverageScenes(): by scene the part of the
/// blocks of 2^3 voxels whose error is below twice the estimate, and the estimated over the true error, root mean
/// squares. Prints a line a scene and solver, and a table of the solvers.
/// @param quick  a few scenes
/// @param only  name of one solver: maps, ordinates or lattice; empty: all
void PrintCoverage(tyndall::Device& device, bool quick, const std::string& only);
}
