#pragma once

#include <cstddef>

namespace tyndall
{
/// Work-items of the kernels that cross a plane on a GPU, by group: along u, whose voxels mostly lie together, and
/// along v.
inline constexpr std::size_t GroupU = 32, GroupV = 4;
inline constexpr double SecondsPerRay = 1e-10; ///< through a voxel: only says how often to wait
}
