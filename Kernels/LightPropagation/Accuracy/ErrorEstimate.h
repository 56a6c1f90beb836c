#pragma once

#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"

#include "Device/Monitor.h"
#include "Distribution/CoarseBlocks.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <functional>
#include <vector>

namespace tyndall
{
/// Solves a medium in the same box, with illumination given on its grid.
using PropagationSolver =
  std::function<LightField(const Medium&, const Illumination&, const PropagationSettings&, const Monitor&)>;

/// A decomposed scene: medium and illumination of this rank's block.
struct SceneInBlocks
{
  Communicator& others;
  const BlockPartition& partition;
  const Medium& medium;
  const Illumination& illumination;
};

/// Solver of a decomposed scene. Collective.
using SolverInBlocks = std::function<LightField(const SceneInBlocks&, const PropagationSettings&, const Monitor&)>;

/// A scene held by a single rank, and its solver.
class SceneOnOneRank
{
public:
  SceneOnOneRank(const Medium& medium, const Illumination& illumination, const PropagationSolver& solve);
  SceneOnOneRank(const SceneOnOneRank&) = delete;
  SceneOnOneRank& operator=(const SceneOnOneRank&) = delete;

  SceneInBlocks Scene() { return { this->Alone, this->Partition, this->TheMedium, this->Light }; }
  SolverInBlocks Solver() const;

private:
  SingleRank Alone;
  const BlockPartition Partition;
  const Medium& TheMedium;
  const Illumination& Light;
  const PropagationSolver& Solve;
};

/// The two error components of Eq. (84) that are estimated separately, as root mean squares relative to that of
/// fluence, and the residual.
struct ErrorParts
{
  double inSpace = 0.0, inDirections = 0.0, residual = 0.0;
};

/// Sets fluenceError and relativeError of `light` (Eqs. (82) to (84)). Collective; the return value and relativeError
/// are global.
/// @param light  of this rank's block
/// @param same, other  fluence of this rank's coarse voxels, with the same quadrature and with another one
/// @param partOfDifference  ratio of the angular error of `light` to the difference between the two coarse solutions
/// @param orderInSpace  order of convergence in the voxel size
ErrorParts WriteErrorEstimate(LightField& light, const CoarseBlocks& blocks, const std::vector<float>& same,
  const std::vector<float>& other, double partOfDifference, double orderInSpace);

/// Solves, and estimates the error of fluence without a reference, from two more solves on a grid of half the voxels
/// per axis (numerics.md, section 9.2):
///  - in voxel size, of order 2 (Richardson), Eq. (82);
///  - in angle, from a solve with 0.6 times as many directions along the edge of a cube face, Eq. (83);
///  - of scattering orders not computed: the residual.
/// fluenceError is a standard error, Eq. (84); relativeError is that of all voxels. The estimate is too large if the
/// medium has edges as sharp as a voxel (coarsening blurs them), and wrong by up to a factor of two either way next to
/// a lamp. Measured accuracy: measurements.md.
///
/// A solve that stopped after its first order with light left has no estimate, because one order does not show the rate
/// of decrease: relativeError is NaN, and fluenceError empty.
///
/// Takes 1 / 8 + 1 / 20 of the time of the sweeps, more on small grids. An axis of a single voxel is not coarsened, and
/// its error in voxel size is not estimated.
LightField SolveWithErrorEstimate(const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor, const PropagationSolver& solve);

/// The same for a decomposed scene. The coarse grid is that of the domain (CoarseBlocks.h), so that errors do not
/// depend on the blocks, except by rounding. Collective; all ranks must have the same kinds of fields.
LightField SolveWithErrorEstimate(
  const SceneInBlocks& scene, const PropagationSettings& settings, const Monitor& monitor, const SolverInBlocks& solve);
}
