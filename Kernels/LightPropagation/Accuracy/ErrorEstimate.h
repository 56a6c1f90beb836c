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
/// Solves a medium of the same box, with the same light on its grid, with settings.
using PropagationSolver =
  std::function<LightField(const Medium&, const Illumination&, const PropagationSettings&, const Monitor&)>;

/// A medium that is spread over ranks by blocks, and what shines on it, of this rank's block.
struct SceneInBlocks
{
  Communicator& others;
  const BlockPartition& partition;
  const Medium& medium;
  const Illumination& illumination;
};

/// The same of such a scene. All ranks call it together.
using SolverInBlocks = std::function<LightField(const SceneInBlocks&, const PropagationSettings&, const Monitor&)>;

/// A scene that one rank has whole, and its solver.
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

/// Errors of light by the two parts of Eq. (84) that are looked at apart, each a root mean square over that of fluence.
struct ErrorParts
{
  double inSpace = 0.0, inDirections = 0.0, residual = 0.0;
};

/// Fills in fluenceError and relativeError of light (Eqs. (82) to (84)). All ranks call it; what it returns, and
/// relativeError, are of all.
/// @param light  of this rank's block
/// @param same, other  fluence of this rank's coarse voxels, along the same directions and along others
/// @param partOfDifference  error of the light's directions over its difference to that of the others
/// @param orderInSpace  that the error falls with in voxel size
ErrorParts WriteErrorEstimate(LightField& light, const CoarseBlocks& blocks, const std::vector<float>& same,
  const std::vector<float>& other, double partOfDifference, double orderInSpace);

/// Solve, and estimate the error of fluence without a reference, from two more solves on a grid of half the voxels an
/// axis (numerics.md, section 9.2):
///  - in voxel size, of order 2 (Richardson), Eq. (82);
///  - in directions, by 0.6 times as many along a face's edge, Eq. (83);
///  - of scattering orders that were not computed: the residual.
/// fluenceError is a standard error, Eq. (84); relativeError that of all voxels. Too large where the medium has edges
/// as sharp as a voxel (coarsening blurs them), and next to a lamp too large or too small by up to a factor of two.
/// What was measured: measurements.md.
///
/// Not known of a solve that was stopped after its first order while light was left: one order does not tell how fast
/// orders shrink. relativeError is NaN then, and fluenceError empty.
///
/// Takes 1 / 8 + 1 / 20 of the sweeps' time, more where the grid is small. An axis of a single voxel is not coarsened,
/// and its error in voxel size not seen.
LightField SolveWithErrorEstimate(const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings, const Monitor& monitor, const PropagationSolver& solve);

/// The same of a scene that is spread over ranks; the coarse grid is that of the whole (CoarseBlocks.h), so that errors
/// do not depend on the blocks, but for rounding. All ranks call it together, with a scene that is alike on all in what
/// it has.
LightField SolveWithErrorEstimate(
  const SceneInBlocks& scene, const PropagationSettings& settings, const Monitor& monitor, const SolverInBlocks& solve);
}
