#pragma once

#include "Light/Quality.h"
#include "LightPropagation/PropagationSettings.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// How light collides in a voxel.
enum class LatticeScheme
{
  Published = 0,   ///< explicit, as printed: positive only up to sigma_t h = 1 (Bernabei et al., Eq. (5))
  Conservative = 1 ///< positive, and power is kept, for voxels of any optical thickness (numerics.md, Eqs. (L2), (L3))
};

/// How light diffuses on a lattice.
struct LatticeSettings
{
  /// Neighbours that a voxel exchanges light with: 18 (Geist et al. 2004), or 6 along the axes.
  int directions = 18;
  LatticeScheme scheme = LatticeScheme::Conservative;
  /// Edge of blocks, voxels, 2 to 8, that step apart from each other as published; 0: all voxels step together.
  int blockSize = 0;
  int stepsPerExchange =
    8;                     ///< steps in a block before it exchanges light with its neighbours, and of a turn of photons
  int maximumSteps = 0;    ///< number of steps; 0: until the tolerance is met
  double tolerance = 1e-4; ///< relative error of fluence at which to stop, estimated
  /// Solve for the steady state, if the scheme is conservative, there are no blocks and maximumSteps is 0; false: step
  /// until the tolerance is met.
  bool solvesSteady = true;
  /// Number of evenly spread voxels at which changes are measured; 0: all. Reading all costs about a step.
  int probes = 4096;
  /// Photons (if any are given) march while the light that they have deposited diffuses in steps;
  /// stepsPerExchange of these to `stretches` of a photon's way from voxel wall to voxel wall (0: to its end). False:
  /// they march to their ends first.
  bool interleaves = false;
  int stretches = 16;
  bool sideBySide = true; ///< if interleaved; false: photons and lattice take turns on the device
  std::array<bool, 3> periodic = {};
  bool netFlux = false; ///< compute net_flux too

  bool Solves() const
  {
    return this->solvesSteady && this->scheme == LatticeScheme::Conservative && this->blockSize == 0 &&
      this->maximumSteps == 0 && !this->interleaves;
  }
};

/// @throws InvalidInput where there are not 6 or 18 directions, a number is out of its range or the tolerance is not
///   positive
void Check(const LatticeSettings& settings);

/// The setting that takes steps instead of solving for the steady state, which is done on one rank only, in words for
/// an error; empty: none does.
std::string NotInBlocks(const LatticeSettings& settings);

/// Settings for the parts of light propagation maps that serve the lattice.
/// @param angularDegree  as PropagationSettings has it
PropagationSettings AsPropagation(const LatticeSettings& settings, int angularDegree = -1);

/// Settings of a quality: directions and tolerance, as far as `settings` has them at their default values. No quality
/// removes the error of diffusion itself.
LatticeSettings AtQuality(Quality quality, LatticeSettings settings);

/// "Name = value" of each setting that a quality may choose.
std::vector<std::string> Words(const LatticeSettings& settings);
}
