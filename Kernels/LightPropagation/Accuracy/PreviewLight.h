#pragma once

#include "Distribution/BlockPartition.h"
#include "Light/LightField.h"
#include "LightPropagation/Accuracy/ErrorEstimate.h"
#include "Lights/Lights.h"
#include "Medium/Field.h"
#include "Medium/Grid.h"
#include "Medium/Medium.h"

#include <cstddef>
#include <functional>

namespace tyndall
{
/// Input of a preview. Its arrays must outlive it.
struct PreviewScene
{
  const Medium& medium;
  const Illumination& illumination;
  Field index; ///< another quantity by voxel, such as the refractive index; may have no values
};

/// Solves a scene in the same box.
using PreviewSolver = std::function<LightField(const PreviewScene&)>;
/// Solves this rank's block of a decomposed scene. Collective.
using PreviewSolverInBlocks = std::function<LightField(const PreviewScene&, const BlockPartition&)>;

/// Grid of a preview: the number of voxels along each axis is halved once, and again while more than PreviewVoxels are
/// left.
Grid PreviewGrid(const Grid& grid);

/// The same in whole steps, so that cubic voxels stay cubic; returns the grid unchanged if some axis cannot be halved.
Grid CubicPreviewGrid(const Grid& grid);

/// Solves on a coarser grid of averages (Coarsening.h) and interpolates linearly between coarse voxel centres: fast
/// feedback while parameters change. The result has `fluence`, `fluence_direct`, powers and the table of iterations.
/// All other data by voxel, face or direction are omitted; `leftOut` says so, and how coarse the grid is.
/// @param coarse  a grid over the box of the medium, nowhere finer than its grid
LightField SolvePreview(const PreviewScene& scene, const Grid& coarse, const PreviewSolver& solve);

/// The same for a decomposed scene: each rank averages its own block, the first rank that has voxels solves the coarse
/// grid, and each rank receives its part. The result equals that of a serial preview for any decomposition. Use it for
/// grids of at most PreviewVoxels, which one rank solves faster than several. Collective.
/// @param own  this rank's block
/// @param index  its refractive index; on all ranks or on none
/// @param alike  settings that must be the same on all ranks, as must the scene
/// @throws InvalidInput  on every rank, if they differ
/// @throws the exceptions of `solve`
LightField SolvePreviewOnFirst(const SceneInBlocks& own, const Field& index, const PropagationSettings& alike,
  const Grid& coarse, const PreviewSolver& solve);

/// The same for larger coarse grids, which are decomposed and solved by all ranks. Equals the serial preview as far as
/// `solve` equals a serial solve.
LightField SolvePreviewInBlocks(const SceneInBlocks& own, const Field& index, const PropagationSettings& alike,
  const Grid& coarse, const PreviewSolverInBlocks& solve);

constexpr double PreviewTolerance = 0.1; ///< tolerance of its iterations: relative error of fluence
constexpr int PreviewDirections = 4;     ///< per cube face
constexpr int PreviewOrders = 24;        ///< of discrete ordinates; later orders are extrapolated as a geometric series

/// Number of voxels for which a preview takes less than 0.2 s on two cores (measurements.md).
constexpr std::size_t PreviewVoxels = 32768;
}
