#pragma once

#include "Light/LightField.h"
#include "Medium/Medium.h"

#include <functional>

namespace tyndall
{
/// Finds light in the medium and with the light that it is given, which have the same box.
using SolveIn = std::function<LightField(const Medium&, const Illumination&)>;

/// What a solver finds with half as many voxels along each axis (averages; Coarsening.h), linear between their middles:
/// to look at while something is changed. `fluence`, `fluence_direct`, powers and the table of iterations; whatever
/// else is known by voxel, face or direction is left out, and `leftOut` says so.
LightField SolvePreview(const Medium& medium, const Illumination& illumination, const SolveIn& solve);

constexpr double PreviewTolerance = 0.1; ///< relative error of fluence that its iterations may leave
constexpr int PreviewDirections = 4;     ///< per cube face
}
