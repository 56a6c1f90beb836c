#pragma once

#include "Light/Quality.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Grid.h"

#include <array>
#include <string>
#include <vector>

namespace tyndall
{
/// Collision scheme of a voxel.
enum class LatticeScheme
{
  Published = 0,   ///< explicit, as printed: positive only up to sigma_t h = 1 (Bernabei et al., Eq. (5))
  Conservative = 1 ///< positive and energy-conserving for any optical thickness (numerics.md, Eqs. (L2), (L3))
};

/// Settings of the lattice-Boltzmann solver.
struct LatticeSettings
{
  /// Number of neighbours with which a voxel exchanges light: 18 (Geist et al. 2004), or 6 along the axes.
  int directions = 18;
  LatticeScheme scheme = LatticeScheme::Conservative;
  /// Edge, in voxels (2 to 8), of the blocks of the published method, which take several steps between exchanges of
  /// light; 0: all voxels step together.
  int blockSize = 0;
  /// Number of steps in a block between exchanges of light. If lattice and photons are interleaved, number of lattice
  /// steps taken each time the photons have marched the next segments of their paths.
  int stepsPerExchange = 8;
  int maximumSteps = 0;    ///< number of steps; 0: step until the tolerance is met
  double tolerance = 1e-4; ///< estimated relative error of the fluence at which to stop
  /// Whether to solve directly for the steady state, if the scheme is conservative and blockSize and maximumSteps are
  /// 0; false: step until the tolerance is met.
  bool solvesSteady = true;
  /// Number of evenly spread voxels at which the change of fluence is measured; 0: all voxels. Reading all voxels costs
  /// about as much as a step.
  int probes = 4096;
  /// Whether photons, if any are given, march interleaved with lattice steps that diffuse the light deposited so far:
  /// stepsPerExchange steps per `stretches` segments of a photon's path, from voxel wall to voxel wall (0: the whole
  /// path). False: photons march to their ends first.
  bool interleaves = false;
  int stretches = 16;
  /// If interleaved: whether photons and lattice run concurrently on the device; false: alternately.
  bool sideBySide = true;
  std::array<bool, 3> periodic = {};
  bool netFlux = false; ///< whether to compute net_flux
  bool leaveOut = true; ///< whether to skip work that the scene does not need

  bool Solves() const
  {
    return this->solvesSteady && this->scheme == LatticeScheme::Conservative && this->blockSize == 0 &&
      this->maximumSteps == 0 && !this->interleaves;
  }
};

/// Whether voxels are cubes to 0.1%, as the lattice requires.
bool HasCubicVoxels(const Grid& grid);

/// Checks the ranges of settings.
/// @throws InvalidInput if `directions` is not 6 or 18, a number is out of its range or the tolerance is not positive
void Check(const LatticeSettings& settings);

/// Name, for the text of an error, of the setting that makes the solver take lattice steps, which is possible on one
/// rank only. Empty if the solver finds the steady state directly.
std::string NotInBlocks(const LatticeSettings& settings);

/// Settings for the light propagation maps that compute the uncollided light of a lattice solve.
/// @param angularDegree  degree of the angular moments of scattering; -1: chosen by the solver; 0: isotropic
PropagationSettings AsPropagation(const LatticeSettings& settings, int angularDegree = -1);

/// Sets directions and tolerance for a quality, unless they differ from their defaults. No quality removes the error of
/// the diffusion approximation.
LatticeSettings AtQuality(Quality quality, LatticeSettings settings);

/// "Name = value" for each setting that a quality may choose.
std::vector<std::string> Words(const LatticeSettings& settings);
}
