#pragma once

#include <array>
#include <limits>

namespace tyndall
{
/// Red, green, blue.
using Rgb = std::array<double, 3>;

inline double Sum(const Rgb& rgb)
{
  return rgb[0] + rgb[1] + rgb[2];
}

inline Rgb Times(const Rgb& rgb, double factor)
{
  return { rgb[0] * factor, rgb[1] * factor, rgb[2] * factor };
}

inline bool IsBlack(const Rgb& rgb)
{
  return rgb == Rgb{};
}

/// Whether the value can be a power or radiance: not negative, and within the range of floats, which kernels use.
inline bool IsUsable(double value)
{
  return value >= 0.0 && value <= std::numeric_limits<float>::max();
}
}
