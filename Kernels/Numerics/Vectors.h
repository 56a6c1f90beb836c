#pragma once

#include "Device/OpenCL.h"

#include <glm/vec3.hpp>

#include <array>

namespace tyndall
{
inline glm::dvec3 Vector(const std::array<double, 3>& v)
{
  return { v[0], v[1], v[2] };
}

/// As kernels take them.
inline cl_float4 Float4(const glm::dvec3& v, double w = 0.0)
{
  return { { static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z), static_cast<float>(w) } };
}
inline cl_int4 Int4(const std::array<int, 3>& v)
{
  return { { v[0], v[1], v[2], 0 } };
}
}
