#pragma once

#include "LightPropagation/PlaneParallel/HalfRangeQuadrature.h"
#include "PhaseFunction/DeltaM.h"

#include <Eigen/Core>

namespace tyndall
{
/// How a medium scatters, per mean free path.
struct LayerScattering
{
  double absorbed = 1.0; ///< 1 - albedo; given apart, for of 1 - 1e-12 nothing is left in an albedo
  DeltaM phase;          ///< what goes straight on is no part of it

  double Albedo() const { return 1.0 - this->absorbed; }
};

/// Modes of light in a uniform layer that varies with depth alone (numerics.md, Eqs. (P3) to (P6)): of radiance down
/// and up at the nodes, each times the square root of its weight, the sum is X a(z), the difference Y b(z), and
///   a' = -b + Y^T d,   b' = -k^2 a + X^T s
/// for each mode by itself, with z in mean free paths, and s, d the sum and difference of sources. So modes need no
/// exponentials that grow, and none but one (k = 0 where nothing is absorbed) needs a limit.
struct LayerModes
{
  /// @param order  of the Fourier series in azimuth
  LayerModes(const LayerScattering& scattering, const HalfRangeQuadrature& nodes, int order);

  Eigen::MatrixXd x, y, inverseX;
  Eigen::VectorXd k; ///< >= 0, rising
};

/// sqrt(weight) times the normalised Legendre functions at the nodes; column l.
Eigen::MatrixXd LegendreAtNodes(const HalfRangeQuadrature& nodes, int degree, int order);
}
