#pragma once

#include "LightPropagation/PlaneParallel/HalfRangeQuadrature.h"
#include "PhaseFunction/DeltaM.h"

#include <Eigen/Core>

namespace tyndall
{
/// Scattering of a medium, per mean free path.
struct LayerScattering
{
  double absorbed = 1.0; ///< 1 - albedo; stored separately to keep digits near albedo 1
  DeltaM phase;          ///< without the unscattered forward part

  double Albedo() const { return 1.0 - this->absorbed; }
};

/// Eigenmodes of radiance in a uniform plane-parallel layer (numerics.md, Eqs. (P3) to (P6)). Multiply downward and
/// upward radiance at each node by the square root of its weight; their sum is X a(z), their difference Y b(z), and
/// each mode satisfies
///   a' = -b + Y^T d,   b' = -k^2 a + X^T s
/// independently, with z in mean free paths, and s, d the sum and difference of the sources. In this form modes need no
/// growing exponentials, and only one (k = 0 without absorption) needs a limit.
struct LayerModes
{
  /// @param order  of the Fourier series in azimuth
  LayerModes(const LayerScattering& scattering, const HalfRangeQuadrature& nodes, int order);

  Eigen::MatrixXd x, y, inverseX;
  Eigen::VectorXd k; ///< >= 0, ascending
};

/// Normalised Legendre functions at the nodes, times sqrt(weight); column l.
Eigen::MatrixXd LegendreAtNodes(const HalfRangeQuadrature& nodes, int degree, int order);
}
