#include "Reference/BoxMonteCarlo.h"

#include "Reference/RandomWalk.h"

#include <algorithm>
#include <cmath>

namespace
{
using random_walk::Random;
using random_walk::Vec;
constexpr int Absorbed = 6;

/// Evenly where the sun meets the box.
Vec Entry(const WalledBox& box, const Vec& along, Random& random)
{
  Vec across;
  double all = 0.0;
  for (int a = 0; a < 3; ++a)
  {
    across[a] = std::abs(along[a]) * box.edges[(a + 1) % 3] * box.edges[(a + 2) % 3];
    all += across[a];
  }
  double chosen = random() * all;
  int axis = 0;
  while (axis < 2 && chosen >= across[axis])
  {
    chosen -= across[axis++];
  }
  Vec place = { random() * box.edges[0], random() * box.edges[1], random() * box.edges[2] };
  place[axis] = along[axis] > 0.0 ? 0.0 : box.edges[axis];
  return place;
}

/// The face that a photon leaves through in the end, or Absorbed.
int EndOf(const WalledBox& box, Vec place, Vec along, Random& random)
{
  for (;;)
  {
    double toFace = 1e300;
    int axis = 0;
    for (int a = 0; a < 3; ++a)
    {
      const double length = along[a] > 0.0 ? (box.edges[a] - place[a]) / along[a]
        : along[a] < 0.0                   ? place[a] / -along[a]
                                           : 1e300;
      axis = length < toFace ? a : axis;
      toFace = std::min(toFace, length);
    }
    const double free = box.sigma_t > 0.0 ? -std::log(1.0 - random()) / box.sigma_t : 1e300;
    const bool collides = free < toFace;
    for (int a = 0; a < 3; ++a)
    {
      place[a] = std::clamp(place[a] + std::min(free, toFace) * along[a], 0.0, box.edges[a]);
    }
    if (collides)
    {
      if (random() >= box.albedo)
      {
        return Absorbed;
      }
      along = random_walk::Scattered(along, box.g, random);
      continue;
    }
    const bool high = along[axis] > 0.0;
    const int face = 2 * axis + (high ? 1 : 0);
    if (random() >= box.faceAlbedo[face])
    {
      return face;
    }
    place[axis] = high ? box.edges[axis] : 0.0;
    Vec inward = { 0.0, 0.0, 0.0 };
    inward[axis] = high ? -1.0 : 1.0;
    along = random_walk::Diffuse(inward, random);
  }
}
}

PowersInBox PowersByMonteCarlo(const WalledBox& box, int photons, std::uint64_t seed)
{
  Random random(seed);
  const double length = std::hypot(box.sunTravels[0], box.sunTravels[1], box.sunTravels[2]);
  const Vec along = { box.sunTravels[0] / length, box.sunTravels[1] / length, box.sunTravels[2] / length };
  std::array<double, 7> counts = {};
  for (int n = 0; n < photons; ++n)
  {
    counts[EndOf(box, Entry(box, along, random), along, random)] += 1.0;
  }
  const auto errorOf = [&](double part) { return std::sqrt(part * (1.0 - part) / photons); };
  PowersInBox powers;
  for (int face = 0; face < 6; ++face)
  {
    powers.out[face] = counts[face] / photons;
    powers.outError[face] = errorOf(powers.out[face]);
  }
  powers.absorbed = counts[Absorbed] / photons;
  powers.absorbedError = errorOf(powers.absorbed);
  return powers;
}
