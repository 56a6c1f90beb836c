#pragma once

#include "Device/Device.h"
#include "Device/MemoryBudget.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// Parameters that determine the memory of a solve.
struct SolveExtent
{
  std::array<int, 3> size; ///< voxels of the domain or of a rank's block
  const PropagationSettings& settings;
  int channels = 1;
  int degree = 0; ///< of angular moments
  IterationScheme how = IterationScheme::SourceIteration;
  bool byOctant = false; ///< the source of a voxel differs between octants
  bool byCells = false;  ///< light is stored by cell of the box faces
  bool ofBlock = false;  ///< of a rank's block, swept one bundle of rays at a time
};
/// Collective.
SolveExtent ExtentOf(const PropagationProblem& problem, IterationScheme how);

/// Upper bound on the device memory of a solve without streaming, in bytes; about a quarter above the typical need.
/// GPUs take more if available: separate arrays for all marching directions (SweepOnGpu.h).
std::size_t BytesOfSolve(const Device& device, const SolveExtent& solve);

/// Device memory that a solve may use: `asked` bytes or, if 0, nine tenths of what is free. Arrays beyond that stay in
/// host memory. A device that shares host memory has no limit of its own.
MemoryBudget BudgetAskedFor(const Device& device, std::size_t asked);

/// The same with the budget of solve.settings. If the solve needs more, all arrays over voxels stay in host memory and
/// are streamed.
MemoryBudget BudgetOfSolve(const Device& device, const SolveExtent& solve);
}
