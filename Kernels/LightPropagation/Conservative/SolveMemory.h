#pragma once

#include "Device/Device.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"

#include <cstddef>

namespace tyndall
{
/// Device memory, in bytes, with which a solve need not stream arrays: an estimate, about a quarter above the typical
/// need. A GPU uses further free memory, if there is any, for separate arrays of each marching direction
/// (SweepOnGpu.h). Collective.
std::size_t BytesOfSolve(const Device& device, const PropagationProblem& problem, IterationScheme how);

/// Memory budget of a solve on a device: settings.memoryBudget bytes or, if that is 0, nine tenths of the free memory.
/// If the solve needs more, all arrays over voxels are kept in host memory and streamed. A device that shares the
/// host's memory has no limit unless settings.memoryBudget sets one. Collective.
MemoryBudget BudgetOfSolve(const Device& device, const PropagationProblem& problem, IterationScheme how);
}
