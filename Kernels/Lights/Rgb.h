#pragma once

#include <array>

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
}
