#include "LightPropagation/PlaneParallel/LayerModes.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace tyndall
{
Eigen::MatrixXd LegendreAtNodes(const HalfRangeQuadrature& nodes, int degree, int order)
{
  const auto count = static_cast<int>(nodes.cosines.size());
  Eigen::MatrixXd values(count, degree + 1);
  for (int i = 0; i < count; ++i)
  {
    const std::vector<double> at = NormalisedLegendre(degree, order, nodes.cosines[i]);
    for (int l = 0; l <= degree; ++l)
    {
      values(i, l) = std::sqrt(nodes.weights[i]) * at[l];
    }
  }
  return values;
}

namespace
{
/// Identity minus the scattering matrix, restricted to moments whose Legendre functions are even in the cosine, or odd.
Eigen::MatrixXd OneLessScattered(
  const LayerScattering& scattering, const Eigen::MatrixXd& legendre, int order, bool even)
{
  const Eigen::Index count = legendre.rows();
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(count, count);
  for (Eigen::Index l = order; l < legendre.cols(); ++l)
  {
    const double moment = scattering.phase.moments[static_cast<std::size_t>(l)];
    if (((l + order) % 2 == 0) == even && moment != 0.0)
    {
      const auto at = legendre.col(l);
      matrix.noalias() -= scattering.Albedo() * (2.0 * l + 1.0) * moment * at * at.transpose();
    }
  }
  return matrix;
}

/// Square of the smallest k, whose mode is nearly isotropic. Its rounding error would act as absorption, so the
/// contribution of the isotropic part is computed from the absorption instead.
double SmallestSquare(const LayerScattering& scattering, const Eigen::MatrixXd& even, const Eigen::MatrixXd& legendre,
  const Eigen::VectorXd& mode)
{
  const Eigen::VectorXd evenly = legendre.col(0);
  const double part = evenly.dot(mode);
  const Eigen::VectorXd rest = mode - part * evenly;
  return std::max(0.0, scattering.absorbed * part * part + rest.dot(even * rest));
}
}

LayerModes::LayerModes(const LayerScattering& scattering, const HalfRangeQuadrature& nodes, int order)
{
  const Eigen::MatrixXd legendre = LegendreAtNodes(nodes, static_cast<int>(scattering.phase.moments.size()) - 1, order);
  const Eigen::VectorXd cosines =
    Eigen::Map<const Eigen::VectorXd>(nodes.cosines.data(), static_cast<Eigen::Index>(nodes.cosines.size()));
  const Eigen::MatrixXd even = OneLessScattered(scattering, legendre, order, true);
  const Eigen::LLT<Eigen::MatrixXd> odd(OneLessScattered(scattering, legendre, order, false));
  const Eigen::MatrixXd lower = odd.matrixL();
  const Eigen::MatrixXd steep = cosines.cwiseInverse().asDiagonal() * lower;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> found(steep.transpose() * even * steep);
  const Eigen::MatrixXd& vectors = found.eigenvectors();
  this->k = found.eigenvalues().cwiseMax(0.0);
  this->x = steep * vectors;
  this->y = odd.matrixU().solve(vectors);
  this->inverseX = this->y.transpose() * cosines.asDiagonal();
  if (order == 0)
  {
    this->k[0] = SmallestSquare(scattering, even, legendre, this->x.col(0));
  }
  this->k = this->k.cwiseSqrt();
}
}
