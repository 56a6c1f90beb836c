#pragma once

#include "Device/Monitor.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "LatticeBoltzmann/Steady/SteadySystem.h"
#include "Light/LightField.h"

#include <vector>

namespace tyndall
{
/// The steady densities of one channel's lattice, where the scheme is conservative (numerics.md, Eqs. (L7) to (L12)).
///
/// Unknown is what collisions make even, by voxel. Between collisions light goes along lines of links, which are solved
/// at once; the rest is symmetric and positive definite, and solved by conjugate gradients whose preconditioner is the
/// diffusion of the same lattice. So the work hardly grows with thickness, albedo and voxels.
class SteadyLattice
{
public:
  /// @param voxels  the known ones of the box
  /// @param system  of the same; Solve() has it write densities
  SteadyLattice(
    const LatticeBox& box, const LatticeSettings& settings, const LatticeVoxels& voxels, SteadySystem& system);

  /// Fluence of the steady lattice, W / length^2 by voxel, never negative; densities to the lattice.
  /// @param rows  of convergence, one an iteration
  std::vector<float> Solve(const Monitor& monitor, std::vector<ConvergenceRow>& rows);

private:
  using Values = SteadySystem::Values;

  /// Part of a density that is made even and not absorbed, over the weight of the directions that it is sent along.
  double Turns(std::size_t known) const;
  double Dot(const Values& a, const Values& b) const;
  Values EvenOf(const Values& scaled, bool withSources) const;
  Values Arriving(const Values& scaled, bool withSources, bool writes, const Monitor& monitor);
  Values Residual(const Values& scaled, const Monitor& monitor);
  Values Applied(const Values& scaled, const Monitor& monitor);
  Values Preconditioned(const Values& residual);
  void Note(double estimate, double change, int iteration, std::vector<ConvergenceRow>& rows) const;

  const LatticeBox& Box;
  const LatticeSettings& Settings;
  const LatticeVoxels& Voxels;
  SteadySystem& System;
  const std::size_t Count;
  const double CountOfAll;
  double Start;
};
}
