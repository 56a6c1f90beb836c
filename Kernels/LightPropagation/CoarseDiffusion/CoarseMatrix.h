#pragma once

#include "LightPropagation/CoarseDiffusion/CoarseShared.h"
#include "Medium/Grid.h"

#include <vector>

namespace tyndall
{
/// The diffusion matrix on cells (MultigridSolver.h), in rows.
struct CoarseMatrix
{
  std::vector<float> conductance, loss; ///< in the solver's layout
  std::vector<double> borders; ///< escaped power through each cell of the box's faces (BoxFaces.h), per fluence
};

/// @param cells  grid of the cells of `box`; only its size is used
/// @param sigmaT, sigmaS  1/length, summed over the voxels of each cell, x fastest
CoarseMatrix FindCoarseMatrix(const Grid& grid, const CoarseCells& box, const Grid& cells,
  const std::vector<float>& sigmaT, const std::vector<float>& sigmaS);
}
