#pragma once

#include "Device/ExactValues.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LatticeBoltzmann/Distributed/MediumAround.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// The diffusion of a lattice (numerics.md, Eq. (L12)) whose blocks lie on several ranks. Conjugate gradients over all
/// voxels, preconditioned by a step of Jacobi's method before and after a solve on cells of 2 x 2 x 2 or more voxels,
/// which are those of the whole grid, whichever ranks have their voxels; the first rank solves for them by multigrid.
/// The same on any number of ranks, to rounding.
class DiffusionInBlocks
{
public:
  using Values = std::vector<double>;

  /// All ranks make one together, and all of it must stay.
  /// @param settings  with the axes that are periodic in the whole grid
  DiffusionInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition, const LatticeBox& box,
    const LatticeSettings& settings, const LatticeVoxels& voxels);

  /// Of the rank's own voxels, to a tenth of the residual. All ranks call it.
  Values Solve(const Values& residual);

private:
  void LoadVoxels(const LatticeSettings& settings, const LatticeVoxels& voxels);
  void LoadCells();
  std::size_t CellOf(const std::array<int, 3>& voxel) const;
  std::array<int, 3> InWhole(std::size_t voxel) const;
  Values Applied(const std::vector<float>& around) const;
  Values ByCells(const Values& residual);
  void AddCells(const Values& byCells, std::vector<float>& around) const;
  std::vector<float> Preconditioned(const Values& residual);
  double Dot(const Values& a, const std::vector<float>& b);

  Device& TheDevice;
  Communicator& Comm;
  const Halo Around; ///< one layer
  const Grid Whole;
  const std::array<bool, 3> Periodic;
  const LatticeBox& Box;
  std::vector<std::array<float, 6>> Conductance; ///< to the voxel beyond each face; 0: there is none
  std::vector<float> Loss;
  Values Diagonal;
  std::array<int, 3> Halvings = { 0, 0, 0 }; ///< cells have 2^halvings voxels along each axis
  Grid Cells;                                ///< their number alone
  std::unique_ptr<MultigridSolver> Solver;   ///< of the first rank, else null
  ExactValues Found;
};
}
