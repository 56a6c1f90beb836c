#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Accuracy/ResampledScene.h"
#include "LightPropagation/PropagationSettings.h"
#include "Medium/Grid.h"

#include <cstddef>
#include <functional>

namespace tyndall
{
/// Function that solves a scene on the grid of its domain. Collective on that domain.
using PreviewSolver = std::function<LightField(const SceneBlock&)>;

/// Coarse grid of a preview: the number of voxels along each axis is halved once, and again while the grid has more
/// than PreviewVoxels voxels.
Grid PreviewGrid(const Grid& grid);

/// Coarse grid of a preview as PreviewGrid(), but halved only while all numbers of voxels are even, so that cubic
/// voxels remain cubic; the grid itself if it cannot be halved.
Grid CubicPreviewGrid(const Grid& grid);

constexpr double PreviewTolerance = 0.05; ///< tolerance of a preview: relative error of fluence
constexpr int PreviewDirections = 4;      ///< directions of a preview per cube face
/// Scattering orders of a preview by discrete ordinates; later orders are extrapolated as a geometric series.
constexpr int PreviewOrders = 24;

/// Number of voxels for which a preview takes less than 0.2 s on two cores (measurements.md).
constexpr std::size_t PreviewVoxels = 32768;

/// Settings of light propagation maps for a preview: few directions, isotropic scattering, a large tolerance, and no
/// optional output arrays.
PropagationSettings SettingsOfPreview(PropagationSettings settings);

/// Solves a scene on a coarser grid of averages (Coarsening.h) and interpolates linearly between coarse voxel centres:
/// fast feedback while parameters change. The result has `fluence`, `fluence_direct`, powers and the table of
/// iterations. All other data by voxel, face or direction are omitted; `leftOut` states that, and the size of the
/// coarse grid.
///
/// A small coarse grid is gathered and solved by the first rank that has voxels, which is faster than on several ranks;
/// the result then equals that of a serial preview for any decomposition. A larger coarse grid is decomposed.
/// Collective.
/// @param alike  settings; they and the scene are checked to be the same on all ranks
/// @param coarse  grid over the same box as the domain's grid, with at most as many voxels along each axis
/// @param small  largest number of coarse voxels that one rank solves alone
/// @throws InvalidInput  on every rank, if settings or scenes differ
/// @throws the exceptions of `solve`
LightField SolvePreview(const SceneBlock& scene, const PropagationSettings& alike, const Grid& coarse,
  const PreviewSolver& solve, std::size_t small = PreviewVoxels);
}
