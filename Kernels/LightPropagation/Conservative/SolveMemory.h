#pragma once

#include "Device/Device.h"
#include "Device/MemoryBudget.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"

#include <cstddef>

namespace tyndall
{
/// Upper bound on the device memory of a solve without streaming, in bytes; about a quarter above the typical need.
/// GPUs take more if available: separate arrays for all marching directions (SweepOnGpu.h). Collective.
std::size_t BytesOfSolve(const Device& device, const PropagationProblem& problem, IterationScheme how);

/// Device memory that a solve may use: settings.memoryBudget bytes or, if 0, nine tenths of what is free. Arrays beyond
/// that stay in host memory; if the solve needs more, all arrays over voxels do, and are streamed. A device that shares
/// host memory has no limit of its own. Collective.
MemoryBudget BudgetOfSolve(const Device& device, const PropagationProblem& problem, IterationScheme how);
}
