#pragma once

#include "Light/LightField.h"
#include "Medium/Grid.h"
#include "Medium/Medium.h"

#include <cstddef>
#include <functional>

namespace tyndall
{
/// Finds light in the medium and with the light that it is given, which have the same box.
using SolveIn = std::function<LightField(const Medium&, const Illumination&)>;

/// The grid of a preview: half as many voxels along each axis, half of those while more than PreviewVoxels are left.
Grid PreviewGrid(const Grid& grid);

/// The same by whole voxels alone, so that cubes stay cubes: the grid as it was where some axis cannot be halved.
Grid CubicPreviewGrid(const Grid& grid);

/// What a solver finds on a coarser grid (averages; Coarsening.h), linear between its voxels' middles: to look at while
/// something is changed. `fluence`, `fluence_direct`, powers and the table of iterations; whatever else is known by
/// voxel, face or direction is left out, and `leftOut` says so, and how coarse the grid is.
/// @param coarse  over the medium's box, nowhere finer than its grid
LightField SolvePreview(
  const Medium& medium, const Illumination& illumination, const Grid& coarse, const SolveIn& solve);

constexpr double PreviewTolerance = 0.1; ///< relative error of fluence that its iterations may leave
constexpr int PreviewDirections = 4;     ///< per cube face
constexpr int PreviewOrders = 24;        ///< of discrete ordinates; those after them are a geometric series

/// Of which a solver finds a preview in less than 0.2 s on two cores (measurements.md).
constexpr std::size_t PreviewVoxels = 32768;
}
