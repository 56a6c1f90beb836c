#pragma once

#include "PhaseFunction/PhaseFunction.h"

#include <Eigen/Core>
#include <vector>

namespace tyndall
{
/// Half-range quadrature in the cosine, on (0, 1): Gauss's rule in the square root of the cosine, which clusters nodes
/// at grazing directions, where radiance varies fastest. With 16 nodes the transmittance of diffuse light, 2 E_3(tau),
/// is accurate to 1e-7 and its mean within any layer to 2e-5 (Gauss's rule in the cosine: 5e-6, 7e-4).
struct HalfRangeQuadrature
{
  explicit HalfRangeQuadrature(int count);

  std::vector<double> cosines, weights; ///< ascending cosines; weights, whose sum is 1
};

/// Values of sqrt((l - m)! / (l + m)!) P_l^m(x) for l = 0 to `degree`, m = `order`, without the sign (-1)^m; 0 where l
/// < m. |x| <= 1.
std::vector<double> NormalisedLegendre(int degree, int order, double x);

/// Absorption and phase function of a uniform layer, per mean free path.
struct LayerScattering
{
  double absorbed = 1.0; ///< 1 - albedo; stored instead of the albedo to keep digits near albedo 1
  DeltaM phase;          ///< phase function without the forward peak, which is treated as unscattered

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
  /// @param order  order m of the Fourier series in azimuth
  LayerModes(const LayerScattering& scattering, const HalfRangeQuadrature& nodes, int order);

  Eigen::MatrixXd x, y, inverseX;
  Eigen::VectorXd k; ///< decay rates of the modes per mean free path, >= 0, ascending
};

/// Normalised Legendre functions at the nodes (cosines) of the quadrature, times the square root of their weights; row:
/// node, column: degree l.
Eigen::MatrixXd LegendreAtNodes(const HalfRangeQuadrature& nodes, int degree, int order);

/// Reflection and transmission operators of a uniform layer, the same from both sides. They act on vectors with one
/// element per node of the quadrature: radiance times the square root of the node's weight.
struct LayerOperator
{
  /// @param depth  optical thickness of the layer
  LayerOperator(const LayerModes& modes, double depth);

  Eigen::MatrixXd reflect, transmit;
};

/// Light of a layer's internal sources, without incident light.
struct LayerSource
{
  /// Outgoing radiance at the top and at the bottom of the layer, at the quadrature's nodes, times the square root of
  /// their weights
  Eigen::VectorXd up, down;
  /// Means over depth of the amplitudes a, b of the layer's modes (LayerModes), for the solution with a = 0 at top and
  /// bottom.
  Eigen::VectorXd meanA, meanB;

  explicit LayerSource(Eigen::Index nodes);

  /// Adds the light of emission that is uniform in depth.
  /// @param emitted  by node of the quadrature: emission times height of the layer, equal up and down, times the square
  ///   root of the node's weight
  void AddEmission(const LayerModes& modes, const LayerOperator& layer, double depth, const Eigen::VectorXd& emitted);

  /// Adds the light of the first-collision source of a beam, per mean free path.
  /// @param cosine  cosine of the angle between beam and axis of the layers, > 0
  /// @param fromTop  the beam enters at the top; false: at the bottom
  /// @param sum, difference  sum and difference of the first-scattered light forward and backward with respect to the
  ///   beam, where the beam enters, at the quadrature's nodes, times the square root of their weights
  void AddBeam(const LayerModes& modes, const LayerOperator& layer, double depth, double cosine, bool fromTop,
    const Eigen::VectorXd& sum, const Eigen::VectorXd& difference);

private:
  void AddEnds(const LayerModes& modes, const LayerOperator& layer, const Eigen::VectorXd& bAtEntry,
    const Eigen::VectorXd& bAtExit, bool fromTop);
};

/// Radiance averaged over the depth of a layer, at the nodes of the quadrature, times the square root of their weights.
struct LayerMeans
{
  Eigen::VectorXd sum;  ///< mean of downward plus upward radiance
  Eigen::VectorXd flux; ///< mean of downward minus upward radiance
};

/// Means over the depth of a layer of the radiance that its internal sources and the light incident on it cause.
/// @param downAtTop, upAtTop, downAtBottom, upAtBottom  radiance at both boundaries of the layer, at the quadrature's
///   nodes, times the square root of their weights
LayerMeans MeansOf(const LayerModes& modes, const LayerSource& source, double depth, const Eigen::VectorXd& downAtTop,
  const Eigen::VectorXd& upAtTop, const Eigen::VectorXd& downAtBottom, const Eigen::VectorXd& upAtBottom);
}
