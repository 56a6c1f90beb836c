#pragma once

#include "Device/Device.h"
#include "Device/MemoryBudget.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"

#include <cstddef>

namespace tyndall
{
/// Device memory of a solve that does not stream arrays, in bytes: an upper bound, about a quarter above the typical
/// use. If more memory is free, GPUs use more, for separate arrays of all marching directions (SweepOnGpu.h).
/// Collective.
std::size_t BytesOfSolve(const Device& device, const PropagationProblem& problem, IterationScheme how);

/// Memory budget of a solve on a device: settings.memoryBudget bytes or, if that is 0, nine tenths of the free memory.
/// If the solve needs more, all arrays over voxels are kept in host memory and streamed. A device that shares the
/// host's memory has no limit unless settings.memoryBudget sets one. Collective.
MemoryBudget BudgetOfSolve(const Device& device, const PropagationProblem& problem, IterationScheme how);
}
