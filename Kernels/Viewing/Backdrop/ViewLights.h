#pragma once

#include "Viewing/MediumRayCaster.h"

#include <vector>

namespace tyndall
{
/// Points and parallel beams that stand for the lights.
std::vector<SmallLight> SmallLights(const std::vector<Light>& lights, const Grid& grid, int rectangleSamples);

/// Pixels of the environment with a column more on both sides, so that it closes.
std::vector<cl_float4> ClosedEnvironment(const Environment& environment);

/// Voxels of a face's rows, and how many rows it has: along y and z, x and z, or x and y.
std::array<int, 2> FaceSize(const Grid& grid, int face);

/// Values of the cells of the box's faces (BoxFaces.h), each face with a border of one cell that repeats the outermost.
std::vector<cl_float4> WithBorders(const Grid& grid, const std::vector<cl_float4>& cells);

/// Irradiance on a face of the box by the light in the voxels on it, over pi and n^2: the radiance of a white table.
/// With a border of one voxel that repeats the outermost ones.
///
/// By fluence and mean direction, as numerics.md, Eq. (111).
/// @param ior        null: 1
/// @param fromBelow  light may come from the table's side: an environment shines
std::vector<cl_float4> TableLight(
  const Grid& grid, const Field& fluence, const Field& meanDirection, const Field& ior, int face, bool fromBelow);
}
