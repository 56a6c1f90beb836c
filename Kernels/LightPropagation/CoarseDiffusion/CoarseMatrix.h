#pragma once

#include "LightPropagation/CoarseDiffusion/CoarseShared.h"
#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// The matrix of diffusion on cells (MultigridSolver.h), by rows of them.
struct CoarseMatrix
{
  std::vector<float> conductance, loss;       ///< as the solver takes them
  std::array<std::vector<double>, 6> borders; ///< by face of the box: what leaves through each cell over its fluence
};

/// @param sigmaT, sigmaS  1/length, summed over the voxels of each cell, x fastest
CoarseMatrix FindCoarseMatrix(
  const Grid& grid, const CoarseCells& box, const std::vector<float>& sigmaT, const std::vector<float>& sigmaS);
}
