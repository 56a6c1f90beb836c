#pragma once

#include "LightPropagation/CoarseDiffusion/CoarseShared.h"
#include "Medium/Grid.h"

#include <vector>

namespace tyndall
{
/// The matrix of diffusion on cells (MultigridSolver.h), by rows of them.
struct CoarseMatrix
{
  std::vector<float> conductance, loss; ///< as the solver takes them
  std::vector<double> borders;          ///< what leaves the box through each cell (BoxFaces.h) over its fluence
};

/// @param cells  of `box`, their size alone
/// @param sigmaT, sigmaS  1/length, summed over the voxels of each cell, x fastest
CoarseMatrix FindCoarseMatrix(const Grid& grid, const CoarseCells& box, const Grid& cells,
  const std::vector<float>& sigmaT, const std::vector<float>& sigmaS);
}
