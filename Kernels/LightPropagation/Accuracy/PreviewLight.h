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
/// What a preview is of. Arrays must stay.
struct PreviewScene
{
  const Medium& medium;
  const Illumination& illumination;
  Field index; ///< another quantity by voxel, as the refractive index; without values: there is none
};

/// Finds light in a scene that it is given, of the same box.
using PreviewSolver = std::function<LightField(const PreviewScene&)>;
/// The same of this rank's block of one. All ranks call it together.
using PreviewSolverInBlocks = std::function<LightField(const PreviewScene&, const BlockPartition&)>;

/// The grid of a preview: half as many voxels along each axis, half of those while more than PreviewVoxels are left.
Grid PreviewGrid(const Grid& grid);

/// The same by whole voxels alone, so that cubes stay cubes: the grid as it was where some axis cannot be halved.
Grid CubicPreviewGrid(const Grid& grid);

/// What a solver finds on a coarser grid (averages; Coarsening.h), linear between its voxels' middles: to look at while
/// something is changed. `fluence`, `fluence_direct`, powers and the table of iterations; whatever else is known by
/// voxel, face or direction is left out, and `leftOut` says so, and how coarse the grid is.
/// @param coarse  over the medium's box, nowhere finer than its grid
LightField SolvePreview(const PreviewScene& scene, const Grid& coarse, const PreviewSolver& solve);

/// The same of a scene that is spread over ranks: each averages its own part, the first that has voxels solves the
/// coarse grid for all, and each gets what it sees. The light of the whole's preview, whatever the blocks. For grids of
/// PreviewVoxels, which are solved sooner than they are spread. All ranks call it together.
/// @param own  of this rank's block; its index is there on all or on none
/// @param alike  what ranks must have alike of the settings, beside the scene
/// @throws InvalidInput  on each, where they differ, and what `solve` throws
LightField SolvePreviewOnFirst(const SceneInBlocks& own, const Field& index, const PropagationSettings& alike,
  const Grid& coarse, const PreviewSolver& solve);

/// The same where the coarse grid is solved by blocks of its own, for one of more voxels. The light is that of the
/// whole's preview as far as that of `solve` is.
LightField SolvePreviewInBlocks(const SceneInBlocks& own, const Field& index, const PropagationSettings& alike,
  const Grid& coarse, const PreviewSolverInBlocks& solve);

constexpr double PreviewTolerance = 0.1; ///< relative error of fluence that its iterations may leave
constexpr int PreviewDirections = 4;     ///< per cube face
constexpr int PreviewOrders = 24;        ///< of discrete ordinates; those after them are a geometric series

/// Of which a solver finds a preview in less than 0.2 s on two cores (measurements.md).
constexpr std::size_t PreviewVoxels = 32768;
}
