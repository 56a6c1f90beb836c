#pragma once

#include "Device/Device.h"

#include <string>

namespace bench
{
/// How often estimated errors cover true errors, over CoverageScenes(): by scene the part of the blocks (2^3 voxels of
/// a solver's light, 2^2 pixels of a picture of the maps' light) whose error is below twice the estimate, and the
/// estimated over the true error, root mean squares. Prints a line a scene and solver, and a table of the solvers.
/// @param quick  a few scenes
/// @param only  maps, ordinates, lattice or pictures; empty: all
void PrintCoverage(tyndall::Device& device, bool quick, const std::string& only);
}
