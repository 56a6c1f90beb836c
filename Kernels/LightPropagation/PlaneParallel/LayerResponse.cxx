#include "LightPropagation/PlaneParallel/LayerResponse.h"

#include "LightPropagation/PlaneParallel/LayerIntegrals.h"

#include <Eigen/LU>

#include <cmath>

namespace tyndall
{
namespace
{
/// (x a - y b) (x a + y b)^-1 for diagonal a, b.
Eigen::MatrixXd Ratio(const LayerModes& modes, const Eigen::ArrayXd& a, const Eigen::ArrayXd& b)
{
  const Eigen::ArrayXd scale = 1.0 / (a + b); // only the ratio of a and b of a mode matters
  const Eigen::MatrixXd one = modes.x * (a * scale).matrix().asDiagonal();
  const Eigen::MatrixXd other = modes.y * (b * scale).matrix().asDiagonal();
  return (one + other).transpose().partialPivLu().solve((one - other).transpose()).transpose();
}
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

/// Solutions with a = 0 at both ends have incident as well as outgoing light there. This adds the response that cancels
/// the incident part.
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
  constexpr double thin = 1e-3; // the flux is linear in depth to 1e-6
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
