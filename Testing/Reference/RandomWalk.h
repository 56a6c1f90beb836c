#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

/// What the references by Monte Carlo have in common.
namespace random_walk
{
using Vec = std::array<double, 3>;

/// xoshiro256+ (Blackman and Vigna 2018), seeded by splitmix64.
class Random
{
public:
  explicit Random(std::uint64_t seed)
  {
    for (std::uint64_t& word : this->State)
    {
      seed += 0x9e3779b97f4a7c15u;
      std::uint64_t z = seed;
      z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
      z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
      word = z ^ (z >> 31);
    }
  }
  double operator()() ///< in [0, 1)
  {
    std::array<std::uint64_t, 4>& s = this->State;
    const std::uint64_t result = s[0] + s[3], t = s[1] << 17;
    s[2] ^= s[0];
    s[3] ^= s[1];
    s[1] ^= s[2];
    s[0] ^= s[3];
    s[2] ^= t;
    s[3] = (s[3] << 45) | (s[3] >> 19);
    return static_cast<double>(result >> 11) * 0x1p-53;
  }

private:
  std::array<std::uint64_t, 4> State;
};

/// Along `axis` turned by an angle of the given cosine, and about it by `turn`. Unit vectors.
inline Vec Turned(const Vec& axis, double cosine, double turn)
{
  const double sine = std::sqrt(std::max(1.0 - cosine * cosine, 0.0));
  // Two axes across (Duff et al. 2017).
  const double sign = std::copysign(1.0, axis[2]), a = -1.0 / (sign + axis[2]), b = axis[0] * axis[1] * a;
  const Vec u1 = { 1.0 + sign * axis[0] * axis[0] * a, sign * b, -sign * axis[0] };
  const Vec u2 = { b, sign + axis[1] * axis[1] * a, -axis[1] };
  Vec out;
  double square = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    out[i] = cosine * axis[i] + sine * (std::cos(turn) * u1[i] + std::sin(turn) * u2[i]);
    square += out[i] * out[i];
  }
  for (double& component : out)
  {
    component /= std::sqrt(square);
  }
  return out;
}

/// By Henyey and Greenstein's function.
inline Vec Scattered(const Vec& along, double g, Random& random)
{
  const double u = random(), turn = 2.0 * 3.14159265358979323846 * random();
  const double s = (1.0 - g * g) / (1.0 - g + 2.0 * g * u);
  const double cosine = std::abs(g) < 1e-6 ? 2.0 * u - 1.0 : std::clamp((1.0 + g * g - s * s) / (2.0 * g), -1.0, 1.0);
  return Turned(along, cosine, turn);
}

/// As a matt surface sends it off (Lambert).
inline Vec Diffuse(const Vec& normal, Random& random)
{
  const double u = random();
  return Turned(normal, std::sqrt(u), 2.0 * 3.14159265358979323846 * random());
}
}
