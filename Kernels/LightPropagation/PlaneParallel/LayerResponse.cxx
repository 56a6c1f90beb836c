#include "LightPropagation/PlaneParallel/LayerResponse.h"

#include "Numerics/Legendre.h"

#include <algorithm>
#include <cmath>
#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace tyndall
{
namespace
{
/// Argument x below which BeamIntegrals neglects x^2 against 1, and above which it uses differences.
constexpr double Thin = 1e-3;

/// (1 - exp(-r)) / r: mean of exp(-r s) over [0, 1].
double MeanOfExponential(double r)
{
  return r < 1e-8 ? 1.0 - 0.5 * r : -std::expm1(-r) / r;
}

/// Integral of exp(-x (1 - s) - r s) over [0, 1].
double MeanOfBoth(double x, double r)
{
  const double half = 0.5 * (x - r);
  if (std::abs(half) > 1.0)
  {
    return (std::exp(-r) - std::exp(-x)) / (x - r);
  }
  const double sinhOver = std::abs(half) < 1e-4 ? 1.0 + half * half / 6.0 : std::sinh(half) / half;
  return std::exp(-0.5 * (x + r)) * sinhOver;
}

/// Integral of s^power exp(-r s) over [0, 1] for r < 1, by its series.
double SeriesOfMoment(int power, double r)
{
  double term = 1.0, sum = 0.0;
  for (int n = 0; n < 20; ++n)
  {
    sum += term / (n + power + 1.0);
    term *= -r / (n + 1.0);
  }
  return sum;
}

/// Matrix (x a - y b) (x a + y b)^-1 with the matrices x, y of LayerModes and diagonal matrices a, b.
Eigen::MatrixXd Ratio(const LayerModes& modes, const Eigen::ArrayXd& a, const Eigen::ArrayXd& b)
{
  const Eigen::ArrayXd scale = 1.0 / (a + b); // only the ratio a / b of each mode matters
  const Eigen::MatrixXd one = modes.x * (a * scale).matrix().asDiagonal();
  const Eigen::MatrixXd other = modes.y * (b * scale).matrix().asDiagonal();
  return (one + other).transpose().partialPivLu().solve((one - other).transpose()).transpose();
}

/// tanh(x) / x; 1 at 0.
double TanhOver(double x)
{
  return x < 1e-4 ? 1.0 - x * x / 3.0 : std::tanh(x) / x;
}

/// (1 - tanh(x / 2) / (x / 2)) / x^2; 1/12 at 0. This is the mean over [0, 1] of the solution of a'' = x^2 a - 1 with a
/// = 0 at both ends.
double MeanOfEvenSource(double x)
{
  return x < 0.02 ? (1.0 - 0.1 * x * x) / 12.0 : (1.0 - TanhOver(0.5 * x)) / (x * x);
}

/// Integrals of the solution of a'' = x^2 a - exp(-r s) on [0, 1] with a = 0 at both ends: a mode with decay rate x,
/// driven by a beam that is attenuated by exp(-r) across a layer. x, r >= 0.
struct BeamIntegrals
{
  BeamIntegrals(double x, double r);

  double slopeAtEntry; ///< slope a'(0) where the beam enters
  double slopeAtExit;  ///< negative slope, -a'(1), where the beam leaves
  double mean;         ///< mean of a
  double meanBeam;     ///< mean of exp(-r s)
};

BeamIntegrals::BeamIntegrals(double x, double r)
{
  this->meanBeam = MeanOfExponential(r);
  if (x < Thin)
  {
    const double first = r < 1.0 ? SeriesOfMoment(1, r) : (this->meanBeam - std::exp(-r)) / r;
    const double second = r < 1.0 ? SeriesOfMoment(2, r) : (2.0 * first - std::exp(-r)) / r;
    this->slopeAtEntry = this->meanBeam - first;
    this->slopeAtExit = first;
    this->mean = 0.5 * (first - second);
    return;
  }
  const double e = std::exp(-x), one = -std::expm1(-2.0 * x);
  const double along = MeanOfExponential(x + r), against = MeanOfBoth(x, r);
  this->slopeAtEntry = (along - e * against) / one;
  this->slopeAtExit = (against - e * along) / one;
  this->mean = (this->meanBeam - this->slopeAtEntry - this->slopeAtExit) / (x * x);
}
}

HalfRangeQuadrature::HalfRangeQuadrature(int count)
{
  const GaussLegendre rule(count);
  for (int i = 0; i < count; ++i)
  {
    const double root = 0.5 * (1.0 + rule.points[i]);
    this->cosines.push_back(root * root);
    this->weights.push_back(rule.weights[i] * root);
  }
}

std::vector<double> NormalisedLegendre(int degree, int order, double x)
{
  std::vector<double> p(degree + 1, 0.0);
  if (order > degree)
  {
    return p;
  }
  const double sine = std::sqrt(std::max(0.0, (1.0 - x) * (1.0 + x)));
  p[order] = 1.0;
  for (int i = 1; i <= order; ++i)
  {
    p[order] *= sine * std::sqrt((2.0 * i - 1.0) / (2.0 * i));
  }
  const double m = order;
  for (int l = order + 1; l <= degree; ++l)
  {
    const double two = l > order + 1 ? std::sqrt((l - 1.0 - m) * (l - 1.0 + m)) * p[l - 2] : 0.0;
    p[l] = ((2.0 * l - 1.0) * x * p[l - 1] - two) / std::sqrt((l - m) * (l + m));
  }
  return p;
}

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
/// Identity minus the scattering matrix between the nodes (cosines) of the quadrature, from the moments whose Legendre
/// functions are even in the cosine, or from those whose functions are odd.
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

/// Square of the smallest decay rate k, whose mode is nearly isotropic. Its rounding error would act as absorption, so
/// the contribution of the isotropic part of the mode is computed from the absorption instead.
/// @param even  OneLessScattered() of even functions
/// @param mode  radiance of the mode at the nodes of the quadrature, times the square root of their weights
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

LayerOperator::LayerOperator(const LayerModes& modes, double depth)
{
  const Eigen::ArrayXd k = modes.k.array();
  const Eigen::ArrayXd half = 0.5 * depth * (0.5 * depth * k).unaryExpr(&TanhOver); // tanh(k depth / 2) / k
  const Eigen::MatrixXd symmetric = Ratio(modes, Eigen::ArrayXd::Ones(k.size()), k * k * half);
  const Eigen::MatrixXd antisymmetric = Ratio(modes, half, Eigen::ArrayXd::Ones(k.size()));
  this->reflect = 0.5 * (symmetric + antisymmetric);
  this->transmit = 0.5 * (symmetric - antisymmetric);
}

LayerSource::LayerSource(Eigen::Index nodes)
  : up(Eigen::VectorXd::Zero(nodes))
  , down(up)
  , meanA(up)
  , meanB(up)
{
}

/// The particular solution has amplitudes a = 0 at both boundaries of the layer, which implies incident light. Adds the
/// layer's response that cancels this light.
/// @param bAtEntry, bAtExit  amplitudes b of this solution (LayerModes) where the beam enters the layer, and where it
///   leaves
void LayerSource::AddEnds(const LayerModes& modes, const LayerOperator& layer, const Eigen::VectorXd& bAtEntry,
  const Eigen::VectorXd& bAtExit, bool fromTop)
{
  const Eigen::VectorXd entry = 0.5 * (modes.y * bAtEntry), exit = 0.5 * (modes.y * bAtExit);
  (fromTop ? this->up : this->down) += layer.transmit * exit - layer.reflect * entry - entry;
  (fromTop ? this->down : this->up) += exit + layer.reflect * exit - layer.transmit * entry;
}

void LayerSource::AddEmission(
  const LayerModes& modes, const LayerOperator& layer, double depth, const Eigen::VectorXd& emitted)
{
  const Eigen::ArrayXd passed = depth * modes.k.array();
  const Eigen::ArrayXd source = (modes.x.transpose() * emitted).array();
  const Eigen::VectorXd b = source * (0.5 * passed).unaryExpr(&TanhOver);
  this->AddEnds(modes, layer, -b, b, true);
  this->meanA += (2.0 * depth * source * passed.unaryExpr(&MeanOfEvenSource)).matrix();
}

void LayerSource::AddBeam(const LayerModes& modes, const LayerOperator& layer, double depth, double cosine,
  bool fromTop, const Eigen::VectorXd& sum, const Eigen::VectorXd& difference)
{
  const Eigen::VectorXd ofB = modes.y.transpose() * difference;
  const Eigen::VectorXd source = modes.x.transpose() * sum + ofB / cosine;
  const Eigen::Index count = source.size();
  Eigen::VectorXd entry(count), exit(count);
  for (Eigen::Index i = 0; i < count; ++i)
  {
    const BeamIntegrals found(depth * modes.k[i], depth / cosine);
    entry[i] = ofB[i] - depth * source[i] * found.slopeAtEntry;
    exit[i] = ofB[i] * std::exp(-depth / cosine) + depth * source[i] * found.slopeAtExit;
    this->meanA[i] += depth * depth * source[i] * found.mean;
    this->meanB[i] += (fromTop ? 1.0 : -1.0) * ofB[i] * found.meanBeam;
  }
  this->AddEnds(modes, layer, entry, exit, fromTop);
}

LayerMeans MeansOf(const LayerModes& modes, const LayerSource& source, double depth, const Eigen::VectorXd& downAtTop,
  const Eigen::VectorXd& upAtTop, const Eigen::VectorXd& downAtBottom, const Eigen::VectorXd& upAtBottom)
{
  constexpr double thin = 1e-3; // optical thickness below which the flux is linear in depth, to 1e-6
  const Eigen::VectorXd top = modes.inverseX * (downAtTop + upAtTop);
  const Eigen::VectorXd bottom = modes.inverseX * (downAtBottom + upAtBottom);
  const Eigen::VectorXd falloff = (0.5 * depth * modes.k.array()).unaryExpr(&TanhOver);
  LayerMeans means;
  means.sum = modes.x * (source.meanA + falloff.cwiseProduct(0.5 * (top + bottom)));
  means.flux = depth < thin ? Eigen::VectorXd(0.5 * (downAtTop - upAtTop + downAtBottom - upAtBottom))
                            : Eigen::VectorXd(modes.y * (source.meanB + (top - bottom) / depth));
  return means;
}
}
