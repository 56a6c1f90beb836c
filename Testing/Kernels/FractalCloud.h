#pragma once

#include "Medium/Grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

/// A cloud of our own making: a heap of balls whose surface noise of several sizes tears, in a box of edge 1 with some
/// clear air around. The same at every number of voxels, but for what they cannot show.
namespace fractal_cloud
{
inline double Slope(std::int64_t i, std::int64_t j, std::int64_t k, double x, double y, double z)
{
  auto hash = static_cast<std::uint32_t>(i * 0x8da6b343u ^ j * 0xd8163841u ^ k * 0xcb1ab31fu);
  hash = (hash ^ (hash >> 16)) * 0x7feb352du;
  hash = (hash ^ (hash >> 15)) * 0x846ca68bu;
  hash ^= hash >> 16;
  const double u = (hash & 1u) ? x : -x, v = (hash & 2u) ? y : -y, w = (hash & 4u) ? z : -z;
  return (hash >> 3) % 3 == 0 ? u + v : (hash >> 3) % 3 == 1 ? v + w : w + u;
}

/// Perlin's gradient noise, of cells of edge 1.
inline double Noise(double x, double y, double z)
{
  const double fx = std::floor(x), fy = std::floor(y), fz = std::floor(z);
  const auto eased = [](double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); };
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner)
  {
    const int a = corner & 1, b = corner >> 1 & 1, c = corner >> 2;
    const double u = x - fx, v = y - fy, w = z - fz;
    const double weight =
      (a ? eased(u) : 1.0 - eased(u)) * (b ? eased(v) : 1.0 - eased(v)) * (c ? eased(w) : 1.0 - eased(w));
    sum += weight *
      Slope(static_cast<std::int64_t>(fx) + a, static_cast<std::int64_t>(fy) + b, static_cast<std::int64_t>(fz) + c,
        u - a, v - b, w - c);
  }
  return sum;
}

inline double Fractal(double x, double y, double z, int octaves)
{
  double sum = 0.0, weight = 1.0;
  for (int octave = 0; octave < octaves; ++octave, weight *= 0.55)
  {
    sum += weight * Noise(x, y, z);
    x = 2.03 * x + 11.7;
    y = 2.03 * y + 3.1;
    z = 2.03 * z + 7.9;
  }
  return sum;
}

/// Relative density at a place of the unit box, 0 to 1.
inline double Density(double x, double y, double z)
{
  constexpr double Balls[][4] = { { 0.50, 0.50, 0.40, 0.25 }, { 0.34, 0.46, 0.34, 0.18 }, { 0.67, 0.56, 0.35, 0.18 },
    { 0.54, 0.44, 0.60, 0.19 }, { 0.44, 0.62, 0.42, 0.19 }, { 0.60, 0.36, 0.36, 0.17 }, { 0.47, 0.52, 0.74, 0.11 } };
  x = 0.5 + 0.78 * (x - 0.5);
  y = 0.5 + 0.78 * (y - 0.5);
  z = 0.12 + 0.78 * z;
  double deep = -1.0; // below the surface
  for (const auto& ball : Balls)
  {
    deep = std::max(deep, ball[3] - std::hypot(x - ball[0], y - ball[1], z - ball[2]));
  }
  deep += 0.085 * Fractal(7.0 * x, 7.0 * y, 7.0 * z, 5);
  deep = std::min(deep, 0.6 * (z - 0.16)); // a flat base
  const double t = std::clamp(deep / 0.07, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t) * (0.55 + 0.45 * std::clamp((z - 0.15) / 0.6, 0.0, 1.0));
}

/// sigma_t of the voxels of a cube of edge 1, of the given optical thickness along z through the middle.
inline std::vector<float> Extinction(int edge, double thickness)
{
  std::vector<float> sigma_t(static_cast<std::size_t>(edge) * edge * edge);
  double through = 0.0;
  for (int k = 0; k < edge; ++k)
  {
    for (int j = 0; j < edge; ++j)
    {
      for (int i = 0; i < edge; ++i)
      {
        sigma_t[(static_cast<std::size_t>(k) * edge + j) * edge + i] =
          static_cast<float>(Density((i + 0.5) / edge, (j + 0.5) / edge, (k + 0.5) / edge));
      }
    }
    for (int n = 0; n < 64; ++n) // of the noise, whatever the voxels
    {
      through += Density(0.5, 0.5, (k + (n + 0.5) / 64.0) / edge) / (64.0 * edge);
    }
  }
  for (float& value : sigma_t)
  {
    value = static_cast<float>(value * thickness / through);
  }
  return sigma_t;
}
}
