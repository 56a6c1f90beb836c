#pragma once

#include "Device/Monitor.h"
#include "Distribution/CoarseBlocks.h"
#include "Light/LightField.h"
#include "LightPropagation/Accuracy/ResampledScene.h"
#include "LightPropagation/PropagationSettings.h"

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace tyndall
{
/// Function that solves a scene on the grid of its domain. Collective.
using PropagationSolver = std::function<LightField(const SceneBlock&, const PropagationSettings&, const Monitor&)>;

/// Orders of convergence of a solver, in voxel size and in number of directions. Any solver with voxels and directions
/// per cube face can be used; a PropagationSolver ignores settings that it does not know. The default values were
/// measured for light propagation maps (numerics.md, section 9.2).
struct ErrorOrders
{
  double inSpace = 2.0;      ///< error ~ (voxel edge)^inSpace
  double inDirections = 0.9; ///< error ~ (number of directions)^-inDirections
  /// Orders of convergence in voxel size assumed by SolveToTargetError(): in general, and if the scene has lamps with a
  /// position.
  double ofTarget = 1.7, ofTargetBesideLamps = 1.4;
  /// Largest number of directions per cube face that SolveToTargetError() may choose.
  int mostDirections = std::numeric_limits<int>::max();
};

/// Refuses an error estimate or a target error for a published scheme, whose error need not decrease with voxel size
/// and number of directions.
/// @param property  name of the property that asks for it
/// @throws InvalidInput  if `published`
void RefuseAsPublished(bool published, const std::string& property);

/// Components of the error in Eq. (84): the errors due to voxel size and due to the number of directions, as root mean
/// squares relative to the root mean square of the fluence, and the residual of the iteration.
struct ErrorParts
{
  double inSpace = 0.0, inDirections = 0.0, residual = 0.0;
};

/// Sets fluenceError and relativeError of `light` (Eqs. (82) to (84)) from two coarse solutions. Collective; the
/// returned error components and relativeError are global.
/// @param light  light of this rank's subdomain
/// @param same, other  fluence of this rank's coarse voxels: `same` solved with the quadrature of `light`, `other` with
/// a different quadrature
/// @param partOfDifference  ratio of the angular error of `light` to the difference between the two coarse solutions
/// @param orderInSpace  order of convergence in the voxel size
ErrorParts WriteErrorEstimate(LightField& light, const CoarseBlocks& blocks, const std::vector<float>& same,
  const std::vector<float>& other, double partOfDifference, double orderInSpace);

/// Solves a scene, and estimates the error of its fluence without a reference, from two more solves on a grid of half
/// the voxels per axis (numerics.md, section 9.2). Components of the error:
///  - due to voxel size, with the order of convergence `orders` (Richardson), Eq. (82);
///  - due to the number of directions, from a solve with 0.6 times as many directions along the edge of a cube face,
///    Eq. (83);
///  - due to scattering orders that were not computed: the residual.
/// fluenceError is a standard error by voxel, Eq. (84); relativeError is the root mean square over all voxels. The
/// estimate is too large if the medium has edges as sharp as a voxel (coarsening blurs them), and wrong by up to a
/// factor of two either way next to a lamp. Measured accuracy: measurements.md.
///
/// There is no estimate for a solve that stopped after its first scattering order, before it converged, because one
/// order does not show how fast orders decrease: relativeError is NaN, and fluenceError empty.
///
/// The estimate takes 1 / 8 + 1 / 20 of the time of the sweeps, more on small grids. An axis of a single voxel is not
/// coarsened, and its error in voxel size is not estimated.
///
/// On several ranks the coarse grid is that of the domain (CoarseBlocks.h), so that errors do not depend on the
/// decomposition, except by rounding. Collective; all ranks must have values in the same fields. If the coarse solves
/// use DSA and UncollidedDirections has its default value, boundary light uses the directions of scattered light on the
/// coarse grid. If it used more directions on the fine grid, the estimate is too large by the error of the fewer
/// directions.
/// @throws the exceptions of `solve`
LightField SolveWithErrorEstimate(const SceneBlock& scene, const PropagationSettings& settings, const Monitor& monitor,
  const PropagationSolver& solve, const ErrorOrders& orders = {});
}
