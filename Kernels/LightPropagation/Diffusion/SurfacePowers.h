#pragma once

#include <array>
#include <vector>

namespace tyndall
{
/// Power of one channel through the cells of the box's faces, W / length^2, without uncollided light of lamps.
struct SurfacePowers
{
  std::vector<double> net;       ///< outgoing minus incoming, by cell (BoxFaces.h)
  std::array<double, 6> in = {}; ///< incident through each face, averaged over its cells
  std::vector<double> back;      ///< reflected power by cell; empty: no face reflects
  const float* lamps = nullptr;  ///< uncollided fluence of lamps by voxel; null: there are none
  /// halfRange of the quadrature of the incident light: isotropic radiance L gives `in` = 4 pi halfRange L
  double halfRange = 0.25;
};
}
