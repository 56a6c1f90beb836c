#pragma once

#include <algorithm>
#include <cmath>

namespace tyndall
{
/// Planes of voxels along the marching axis, for rays that leave sideways through a face of the box. A ray nearly
/// parallel to the face represents the power that leaves through cells of several planes (Deposit::spreadsAside).
struct AsidePlanes
{
  int size;
  bool periodic;
  bool spreads; ///< false: a ray leaves through the cell of its own plane only
};

/// Calls act(plane, part) for each plane through whose cells a ray leaves, with the part of its power that leaves
/// there; same as in SweepFaces.cl.
/// @param tangent  sideways moves of the ray, voxels per plane
/// @param plane    plane in which the ray moves sideways
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
