#pragma once

#include "Device/ExactValues.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/Lattice.h"
#include "Light/LightField.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"
#include "Medium/Grid.h"

#include <vector>

namespace tyndall
{
/// The steady densities of one channel's lattice, where the scheme is conservative (numerics.md, Eqs. (L7) to (L12)).
///
/// Unknown is what collisions make even, by voxel. Between collisions light goes along lines of links, which are solved
/// at once; the rest is symmetric and positive definite, and solved by conjugate gradients whose preconditioner is the
/// diffusion of the same lattice (MultigridSolver). So the work hardly grows with thickness, albedo and voxels.
class SteadyLattice
{
public:
  /// @param lattice  whose densities Solve() writes
  SteadyLattice(Device& device, const Grid& grid, const LatticeSettings& settings, const LatticeVoxels& voxels,
    const Lattice& lattice);

  /// Fluence of the steady lattice, W / length^2 by voxel, never negative; densities to the lattice.
  /// @param rows  of convergence, one an iteration
  std::vector<float> Solve(const Monitor& monitor, std::vector<ConvergenceRow>& rows);

private:
  using Values = std::vector<double>;

  void Load();
  void LoadDiffusion();
  double Turns(std::size_t voxel) const; ///< part of a density that is made even and not absorbed
  Values Sweep(const Values& even, double shines, bool writes, const Monitor& monitor);
  Values EvenOf(const Values& scaled, bool withSources) const;
  Values Residual(const Values& scaled, const Monitor& monitor);
  Values Applied(const Values& scaled, const Monitor& monitor);
  Values Preconditioned(const Values& residual);
  void Note(double estimate, double imbalance, int iteration, std::vector<ConvergenceRow>& rows) const;

  Device& TheDevice;
  const Grid TheGrid;
  const LatticeSettings& Settings;
  const LatticeVoxels& Voxels;
  const Lattice& Densities;
  std::size_t Count;
  ExactValues Straight, Even, Behind, Share, Sum, Correction;
  Buffer<float> Passes, Squared;
  MultigridSolver Diffusion;
  double Start, Work = 0.0;
};
}
