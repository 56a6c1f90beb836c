#pragma once

#include "Device/Device.h"
#include "Device/MemoryBudget.h"
#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ScatteringOrders.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// What the memory that a solve takes depends on.
struct SolveExtent
{
  std::array<int, 3> size; ///< voxels, of the whole or of a rank's block
  const PropagationSettings& settings;
  int channels = 1;
  int degree = 0; ///< of angular moments
  IterationScheme how = IterationScheme::SourceIteration;
  bool byOctant = false; ///< voxels shine otherwise into each octant
  bool byCells = false;  ///< light comes or goes by cells of the faces
  bool ofBlock = false;  ///< a rank's block is swept, by one set of rays after the other
};
/// Collective.
SolveExtent ExtentOf(const PropagationProblem& problem, IterationScheme how);

/// Bytes that a solve takes of a device where nothing is streamed: at most, and about a quarter more than most solves.
/// GPUs take more where there is room: arrays of their own of all ways at once (SweepOnGpu.h).
std::size_t BytesOfSolve(const Device& device, const SolveExtent& solve);

/// What a solve may take of a device: what was asked for, or (0) nine tenths of what is left there; what does not fit
/// lies in host memory. A device that works on host memory has no bound of its own.
MemoryBudget BudgetAskedFor(const Device& device, std::size_t asked);

/// The same of the settings' budget. Where a whole solve is more than that, all arrays over voxels lie in host memory
/// and are streamed.
MemoryBudget BudgetOfSolve(const Device& device, const SolveExtent& solve);
}
