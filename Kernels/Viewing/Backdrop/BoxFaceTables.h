#pragma once

#include "Device/OpenCL.h"
#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Voxels of a face's rows, and how many rows it has: along y and z, x and z, or x and y.
std::array<int, 2> FaceSize(const Grid& grid, int face);

/// Values of the cells of the box's faces (BoxFaces.h), each face with a border of one cell that repeats the outermost.
std::vector<cl_float4> WithBorders(const Grid& grid, const std::vector<cl_float4>& cells);
}
