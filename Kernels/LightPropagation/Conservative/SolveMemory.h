#pragma once

#include "Device/Device.h"
#include "Device/MemoryBudget.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"

namespace tyndall
{
/// Bytes that a solve takes of a device where nothing is streamed: at most, and about a quarter more than most solves.
/// GPUs take more where there is room: arrays of their own of all ways at once (SweepOnGpu.h).
std::size_t BytesOfSolve(const Device& device, const PropagationProblem& problem, OrdersAdded how);

/// What a solve may take of a device: what was asked for, or (0) nine tenths of what is left there; what does not fit
/// lies in host memory. A device that works on host memory has no bound of its own.
MemoryBudget BudgetAskedFor(const Device& device, std::size_t asked);

/// The same of the settings' budget. Where a whole solve is more than that, all arrays over voxels lie in host memory
/// and are streamed.
MemoryBudget BudgetOfSolve(const Device& device, const PropagationProblem& problem, OrdersAdded how);
}
