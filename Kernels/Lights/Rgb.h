#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace tyndall
{
/// Values in red, green and blue.
using Rgb = std::array<double, 3>;

inline double Sum(const Rgb& rgb)
{
  return rgb[0] + rgb[1] + rgb[2];
}

inline Rgb& operator+=(Rgb& rgb, const Rgb& other)
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    rgb[c] += other[c];
  }
  return rgb;
}

inline Rgb operator+(Rgb rgb, const Rgb& other)
{
  return rgb += other;
}

inline Rgb operator-(const Rgb& rgb, const Rgb& other)
{
  return { rgb[0] - other[0], rgb[1] - other[1], rgb[2] - other[2] };
}

inline Rgb Times(const Rgb& rgb, double factor)
{
  return { rgb[0] * factor, rgb[1] * factor, rgb[2] * factor };
}

inline bool IsBlack(const Rgb& rgb)
{
  return rgb == Rgb{};
}

inline bool IsGrey(const Rgb& rgb)
{
  return rgb[0] == rgb[1] && rgb[1] == rgb[2];
}

/// Whether a value is valid as power or radiance: not negative, and within the range of floats, which kernels use.
inline bool IsUsable(double value)
{
  return value >= 0.0 && value <= std::numeric_limits<float>::max();
}
}
