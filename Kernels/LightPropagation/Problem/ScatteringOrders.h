#pragma once

#include "LightPropagation/Problem/PropagationProblem.h"
#include "LightPropagation/Problem/ThickLines.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Scattering orders, as sweeps carry them, until 1e-4 is left, about: those of diffusion in a slab with extrapolated
/// borders (numerics.md, Eq. (86)); thick lines of voxels stand for the slab.
double OrdersNeeded(const PropagationProblem& problem);

/// So many that adding them up one by one is forecast to take longer than acceleration: both in orders, by what set-up,
/// sweeps and corrections were measured to take (`./run bench thick`).
bool ScatteredManyTimes(const PropagationProblem& problem);

/// The same of isotropic scattering in a box none of whose axes is periodic and none of whose faces reflects.
struct IsotropicChannel
{
  ThickLines lines;
  double albedo = 0.0; ///< mean over what is scattered
};
/// @param inCells  acceleration goes by cells, see AreThinEnough
bool ScatteredManyTimes(const std::vector<IsotropicChannel>& channels, bool inCells);

/// How scattering orders are added up.
enum class OrdersAdded
{
  OneByOne,  ///< Conservative/SourceIteration.h
  ByCells,   ///< the same, each with what diffusion on cells of several voxels says of the rest: where voxels are thin
  ByBalance, ///< between sweeps by the balance of each voxel, Conservative/Acceleration/DiffusionAcceleration.h
};
OrdersAdded HowOrdersAreAdded(const PropagationProblem& problem);

/// Of how many voxels cells are to be along each axis, 2^this, for these to be about a mean free path wide at most
/// where the medium is thickest; all 0: voxels are too thick for cells of several.
std::array<int, 3> CellHalvings(const PropagationProblem& problem);
/// @param thickest  the largest extinction, 1/length
std::array<int, 3> CellHalvings(const Grid& grid, double thickest);
/// Whether cells have several voxels along each axis that the grid has several along.
bool AreThinEnough(const Grid& grid, const std::array<int, 3>& halvings);
}
