#pragma once

#include <vector>

namespace tyndall
{
/// Cosines in (0, 1) and weights of an integral over them: Gauss's rule in the square root of the cosine, so that nodes
/// lie close where light grazes layers and falls off fastest. Of 16 nodes, what diffuse light passes through a layer,
/// 2 E_3(tau), is right to 1e-7, its mean within any layer, to 2e-5 (Gauss's rule in the cosine: 5e-6, 7e-4).
struct HalfRangeQuadrature
{
  explicit HalfRangeQuadrature(int count);

  std::vector<double> cosines, weights; ///< rising; their sum is 1
};

/// sqrt((l - m)! / (l + m)!) P_l^m(x) for l = 0 to `degree`, without the sign (-1)^m; 0 where l < m. |x| <= 1.
std::vector<double> NormalisedLegendre(int degree, int order, double x);
}
