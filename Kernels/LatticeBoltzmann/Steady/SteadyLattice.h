#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "LatticeBoltzmann/Steady/LatticeDiffusion.h"
#include "LatticeBoltzmann/Steady/LinesOfLinks.h"
#include "Light/LightField.h"

#include <vector>

namespace tyndall
{
/// The steady densities of one channel's lattice, where the scheme is conservative (numerics.md, Eqs. (L7) to (L12)).
///
/// The unknown is fluence over n^2, by voxel. Between collisions light moves along lines of links, which are solved
/// directly (LinesOfLinks); what is left is symmetric and positive definite, and solved by conjugate gradients that the
/// diffusion of the same lattice preconditions (LatticeDiffusion). So the number of iterations hardly depends on
/// thickness, albedo or the number of voxels.
class SteadyLattice
{
public:
  /// Collective. All must outlive it.
  /// @param densities  of the block, written by Solve(); null where the block has no voxels
  SteadyLattice(Device& device, const LatticeProblem& problem, const LatticeSettings& settings,
    const LatticeVoxels& voxels, const Lattice* densities);

  /// Collective.
  /// @param rows  of convergence, one an iteration
  /// @return fluence of the steady lattice, W / length^2 by own voxel, never negative
  std::vector<float> Solve(const Monitor& monitor, std::vector<ConvergenceRow>& rows);

private:
  using Values = std::vector<double>;

  /// Part of a density that is made even and not absorbed, over the weight of the directions that it is sent along.
  double Turns(std::size_t known) const;
  double Dot(const Values& a, const Values& b) const;
  Values EvenOf(const Values& scaled, bool withSources) const;
  Values Arriving(const Values& scaled, bool withSources, bool writes, const Monitor& monitor);
  Values Residual(const Values& scaled, const Monitor& monitor);
  Values Applied(const Values& scaled, const Monitor& monitor);
  Values Preconditioned(const Values& residual);
  void Note(double estimate, double change, int iteration, std::vector<ConvergenceRow>& rows) const;

  const Domain& TheDomain;
  const LatticeBox& Box;
  const LatticeSettings& Settings;
  const LatticeVoxels& Voxels;
  LinesOfLinks Lines;
  LatticeDiffusion Diffusion;
  const std::size_t Count;
  const double CountOfAll;
  double Start;
};
}
