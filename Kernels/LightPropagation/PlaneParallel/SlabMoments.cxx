#include "LightPropagation/PlaneParallel/SlabMoments.h"

#include "Numerics/Constants.h"
#include "Numerics/SphericalHarmonics.h"

#include <cmath>

namespace tyndall
{
namespace
{
/// Matrix that projects radiance at the nodes, given as amplitudes of its Fourier series in azimuth, onto each
/// spherical harmonic of the scene axes. Columns: node, down and up, order (cos, then sin).
Eigen::MatrixXd Projection(const SlabScene& scene, const HalfRangeQuadrature& nodes, int degree, int orders)
{
  const auto count = static_cast<int>(nodes.cosines.size());
  const int series = 1 + 2 * orders, around = 2 * (degree + orders) + 1;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero((degree + 1) * (degree + 1), 2 * count * series);
  for (int n = 0; n < 2 * count; ++n)
  {
    const double mu = nodes.cosines[n / 2], sine = std::sqrt(1.0 - mu * mu);
    for (int turn = 0; turn < around; ++turn)
    {
      const double azimuth = 2.0 * Pi * turn / around;
      std::array<double, 3> omega;
      omega[scene.Along()] = n % 2 == 0 ? mu : -mu;
      omega[(scene.Along() + 1) % 3] = sine * std::cos(azimuth);
      omega[(scene.Along() + 2) % 3] = sine * std::sin(azimuth);
      const std::vector<double> harmonics = SphericalHarmonics(degree, omega);
      const Eigen::VectorXd there =
        Eigen::Map<const Eigen::VectorXd>(harmonics.data(), static_cast<Eigen::Index>(harmonics.size()));
      for (int s = 0; s < series; ++s)
      {
        const int m = (s + 1) / 2;
        const double wave = s % 2 == 1 ? std::cos(m * azimuth) : s > 0 ? std::sin(m * azimuth) : 1.0;
        matrix.col(n * series + s) += 2.0 * Pi / around * std::sqrt(nodes.weights[n / 2]) * wave * there;
      }
    }
  }
  return matrix;
}

/// Amplitudes of one layer, in the order of the columns of Projection.
Eigen::VectorXd Amplitudes(const SlabColumn& column, std::size_t layer, int series)
{
  const Eigen::Index count = column.even.means[layer].sum.size();
  Eigen::VectorXd all(2 * count * series);
  for (int s = 0; s < series; ++s)
  {
    const StackSolution& of = s == 0 ? column.even : column.slanting[(s - 1) / 2][(s - 1) % 2];
    const LayerMeans& means = of.means[layer];
    for (Eigen::Index n = 0; n < count; ++n)
    {
      all[2 * n * series + s] = 0.5 * (means.sum[n] + means.flux[n]);
      all[(2 * n + 1) * series + s] = 0.5 * (means.sum[n] - means.flux[n]);
    }
  }
  return all;
}
}

std::vector<double> ScatteredMoments(
  const SlabScene& scene, const SlabColumn& column, const HalfRangeQuadrature& nodes, int degree)
{
  const auto orders = static_cast<int>(column.slanting.size());
  const Eigen::MatrixXd projection = Projection(scene, nodes, degree, orders);
  std::vector<double> moments;
  for (std::size_t i = 0; i < scene.Count(); ++i)
  {
    const Eigen::VectorXd found = projection * Amplitudes(column, i, 1 + 2 * orders);
    const DeltaM& phase = column.stack.kinds[column.stack.layers[i].kind].phase;
    for (Eigen::Index j = 0; j < found.size(); ++j)
    {
      const auto l = static_cast<std::size_t>(DegreeOfTerm(static_cast<int>(j)));
      const double moment = l < phase.moments.size() ? phase.moments[l] : 0.0;
      moments.push_back((1.0 - phase.forward) * moment * found[j] / std::sqrt(4.0 * Pi));
    }
  }
  return moments;
}
}
