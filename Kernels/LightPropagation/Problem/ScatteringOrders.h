#pragma once

#include "LightPropagation/Problem/PropagationProblem.h"
#include "Medium/Grid.h"

#include <array>

namespace tyndall
{
/// Estimated number of scattering orders (source iterations) until about 1e-4 of the light remains. It follows from the
/// decay rate of diffusion in a slab as thick as the thick lines of voxels, with extrapolated boundaries (numerics.md,
/// Eq. (86)). Collective, as are all functions in this header that take a problem.
double OrdersNeeded(const PropagationProblem& problem);

/// Whether source iteration is predicted to take longer than an accelerated solve. Costs of set-up, sweeps and
/// corrections were measured (`./run bench thick`).
bool ScatteredManyTimes(const PropagationProblem& problem);

/// Iteration scheme by which the fluence of all scattering orders is computed.
enum class IterationScheme
{
  SourceIteration, ///< one sweep per scattering order; Conservative/SourceIteration.h
  /// Source iteration with a diffusion correction on cells of several voxels, for optically thin voxels.
  CoarseMeshDsa,
  Dsa, ///< diffusion synthetic acceleration on the voxels; Conservative/Acceleration/DiffusionAcceleration.h
};
/// Whether voxels are over a hundred times longer along one axis than along another: DSA may not converge there, and
/// orders with sources by octant may grow.
bool HasVeryFlatVoxels(const Grid& grid);
/// Chooses the iteration scheme that is predicted to be fastest, unless the settings determine it. Collective.
IterationScheme ChooseIterationScheme(const PropagationProblem& problem);

/// Base-2 logarithm of the number of voxels per cell of coarse-mesh DSA along each axis, such that a cell is at most
/// about one mean free path wide where the medium is thickest. All 0 if voxels are too thick for cells of several
/// voxels.
std::array<int, 3> CellHalvings(const PropagationProblem& problem);
/// CellHalvings() for a grid and its largest extinction.
/// @param thickest  the largest extinction of any voxel, 1/length
std::array<int, 3> CellHalvings(const Grid& grid, double thickest);
}
