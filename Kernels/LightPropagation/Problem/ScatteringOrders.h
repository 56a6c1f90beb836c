#pragma once

#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ThickLines.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Properties of one channel from which the number of scattering orders is estimated.
struct ScatteringOfChannel
{
  ThickLines diffusing; ///< thickness for diffusing light (transport extinction)
  ThickLines swept;     ///< thickness in the extinction that the sweeps use; unused without angular moments
  double albedo = 0.0;  ///< mean albedo, in the coefficients that the sweeps use
};

/// Properties of a scene from which the number of scattering orders is estimated.
struct ScatteringOfScene
{
  Grid grid;
  std::array<bool, 3> periodic = {};
  std::array<Rgb, 6> faceAlbedo = {};
  int degree = 0; ///< of angular moments
  bool isSlab = false;
  double thickest = 0.0; ///< largest extinction of any voxel and channel that the sweeps use, 1/length
  std::vector<ScatteringOfChannel> channels;
};
/// Collective, as are all functions here that take a problem.
ScatteringOfScene ScatteringOf(const PropagationProblem& problem);

/// Estimated number of scattering orders (source iterations) until about 1e-4 of the light is left: the rate of
/// diffusion in a slab with extrapolated boundaries (numerics.md, Eq. (86)), applied to thick lines of voxels.
double OrdersNeeded(const ScatteringOfScene& scene);
double OrdersNeeded(const PropagationProblem& problem);

/// Whether source iteration is predicted to take longer than an accelerated solve. Costs of set-up, sweeps and
/// corrections were measured (`./run bench thick`).
bool ScatteredManyTimes(const ScatteringOfScene& scene);
bool ScatteredManyTimes(const PropagationProblem& problem);

/// Iteration scheme for the fluence of all scattering orders.
enum class IterationScheme
{
  SourceIteration, ///< one sweep per scattering order; Conservative/SourceIteration.h
  /// Source iteration with a diffusion correction on cells of several voxels, for optically thin voxels
  CoarseMeshDsa,
  Dsa, ///< diffusion synthetic acceleration on the voxels; Conservative/Acceleration/DiffusionAcceleration.h
};
/// Fastest scheme for a serial solve. Collective.
IterationScheme FastestScheme(const PropagationProblem& problem);
/// Fastest scheme available on the problem's domain. Collective.
IterationScheme ChooseIterationScheme(const PropagationProblem& problem);
/// Whether the settings request acceleration, or let it depend on the scene.
bool MayBeAccelerated(const PropagationSettings& settings, bool scatters);

/// Base-2 logarithm of the number of voxels per cell of coarse-mesh DSA along each axis, such that a cell is at most
/// about one mean free path wide where the medium is thickest. All 0: voxels are too thick for cells of several voxels.
std::array<int, 3> CellHalvings(const PropagationProblem& problem);
/// @param thickest  the largest extinction, 1/length
std::array<int, 3> CellHalvings(const Grid& grid, double thickest);
/// Whether cells consist of several voxels along each axis on which the grid has more than one voxel.
bool AreThinEnough(const Grid& grid, const std::array<int, 3>& halvings);
}
