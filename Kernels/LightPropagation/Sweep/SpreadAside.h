#pragma once

#include <algorithm>
#include <cmath>

namespace tyndall
{
/// Planes of voxels that rays march through, where they move aside through a face of the box: of those that run nearly
/// along it each stands for what passes the cells of several planes (Deposit::spreadsAside).
struct AsidePlanes
{
  int size;
  bool periodic;
  bool spreads; ///< false: a ray passes the cell of its own plane alone
};

/// Calls act(plane, part) for each plane whose cells a ray passes, as SweepFaces.cl has it.
/// @param tangent  moves aside, voxels a plane
/// @param plane    in which it moves
template <class Act>
void ForPlanesPassed(const AsidePlanes& aside, double tangent, int plane, const Act& act)
{
  if (!aside.spreads)
  {
    act(plane, 1.0);
    return;
  }
  const double planes = tangent * aside.size > 1.0 ? 1.0 / tangent : aside.size, middle = plane + 0.5;
  const double begin = aside.periodic ? middle - 0.5 * planes : std::max(middle - 0.5 * planes, 0.0);
  const double end = aside.periodic ? middle + 0.5 * planes : std::min(middle + 0.5 * planes, 1.0 * aside.size);
  for (int p = static_cast<int>(std::floor(begin)); p < end; ++p)
  {
    act((p + aside.size) % aside.size, (std::min(end, p + 1.0) - std::max(begin, 1.0 * p)) / (end - begin));
  }
}
}
