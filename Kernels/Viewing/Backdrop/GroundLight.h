#pragma once

#include "Device/OpenCL.h"
#include "Viewing/Scene/SolvedLight.h"

#include <vector>

namespace tyndall
{
/// Radiance that the faces of the box show from within which give back light (numerics.md, Eq. (111a)): albedo / pi
/// times what leaves through each cell. W / (length^2 sr), [face][row][cell of the row] with borders (WithBorders).
/// Empty where no face does, or it is not known what leaves.
std::vector<cl_float4> GroundLight(const Grid& grid, const SolvedLight& light);

/// A bit for each face, -x to +z, that gives back light.
int GroundFaces(const SolvedLight& light);
}
