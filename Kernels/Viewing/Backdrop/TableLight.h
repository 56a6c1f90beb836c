#pragma once

#include "Device/OpenCL.h"
#include "Medium/Medium.h"

#include <vector>

namespace tyndall
{
/// Irradiance on a face of the box by the light in the voxels on it, over pi and n^2: the radiance of a white table.
/// With a border of one voxel that repeats the outermost ones.
///
/// By fluence and mean direction, as numerics.md, Eq. (111).
/// @param ior        null: 1
/// @param fromBelow  light may come from the table's side: an environment shines
std::vector<cl_float4> TableLight(
  const Grid& grid, const Field& fluence, const Field& meanDirection, const Field& ior, int face, bool fromBelow);
}
