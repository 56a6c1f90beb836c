#pragma once

#include "LightPropagation/CoarseDiffusion/CoarseShared.h"
#include "Medium/Grid.h"

#include <vector>

namespace tyndall
{
/// Diffusion matrix on the cells of coarse-mesh DSA (numerics.md, Eq. (76d)), for MultigridSolver.
struct CoarseMatrix
{
  /// Conductances of the cells' low faces, and absorbed power per fluence, length^2, in the memory layout of
  /// MultigridSolver (MultigridLevel).
  std::vector<float> conductance, loss;
  /// Escaped power per fluence through each cell of the box's faces (BoxFaces.h), length^2.
  std::vector<double> borders;
};

/// Computes the diffusion matrix of the cells.
/// @param grid  voxels of the whole domain
/// @param cells  grid of the cells of `box`; only its size is used
/// @param sigmaT, sigmaS  1/length, summed over the voxels of each cell, x fastest
CoarseMatrix FindCoarseMatrix(const Grid& grid, const CoarseCells& box, const Grid& cells,
  const std::vector<float>& sigmaT, const std::vector<float>& sigmaS);
}
