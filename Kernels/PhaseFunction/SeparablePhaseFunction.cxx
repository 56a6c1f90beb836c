#include "PhaseFunction/SeparablePhaseFunction.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"
#include "Numerics/NumberText.h"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace tyndall
{
namespace
{
/// Maximum number of directions for SingularValues: the computation time grows with the cube of their number
constexpr int MostForSingularValues = 1024;
/// A column counts as linearly dependent on earlier ones if less than this fraction of its length remains after
/// projection.
constexpr double Dependent = 1e-3;
constexpr double Nothing = 1e-14; ///< eigenvalues below this, relative to the largest, count as zero (rounding)

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Orthonormal columns, [direction i][term k], and an eigenvalue of the phase matrix per column. A column has the
/// values sqrt(w_i) u_k(i), with the weights w_i of the quadrature and the basis functions u_k of the phase function.
struct Basis
{
  MatrixXd columns;
  VectorXd values;
  std::vector<int> degrees = {}; ///< of spherical harmonics
};

void Check(const std::vector<Direction>& directions, const SeparableSettings& settings)
{
  const int count = static_cast<int>(directions.size());
  const bool bySingularValues = settings.factorisation == PhaseFactorisation::SingularValues;
  if (count < 1 || (bySingularValues && count > MostForSingularValues))
  {
    throw InvalidInput("A separable phase function is made on " + std::to_string(count) +
      " directions; it needs one at least, and for singular values there can be " +
      std::to_string(MostForSingularValues) + " at most: choose spherical harmonics.");
  }
  if (settings.terms < 1 || settings.terms > count)
  {
    throw InvalidInput("A separable phase function is to have " + std::to_string(settings.terms) +
      " terms; it can have from 1 to as many as there are directions, " + std::to_string(count) + ".");
  }
  for (std::size_t d = 0; d < directions.size(); ++d)
  {
    if (!(directions[d].weight > 0.0))
    {
      throw InvalidInput("Direction " + std::to_string(d) + " of a separable phase function has the solid angle " +
        Text("%.6g", directions[d].weight) + " sr; it must be positive.");
    }
  }
}

VectorXd RootsOfWeights(const std::vector<Direction>& directions)
{
  VectorXd roots(directions.size());
  for (std::size_t d = 0; d < directions.size(); ++d)
  {
    roots[d] = std::sqrt(directions[d].weight);
  }
  return roots;
}

double Cosine(const Direction& a, const Direction& b)
{
  return std::clamp(a.omega[0] * b.omega[0] + a.omega[1] * b.omega[1] + a.omega[2] * b.omega[2], -1.0, 1.0);
}

/// Degree beyond which the Legendre moments (CapMoments) of the smallest cell of a direction are below 1e-4. The cell
/// of a direction is a cap whose solid angle is the direction's weight.
int DegreeOfMeans(const std::vector<Direction>& directions)
{
  double least = 4.0 * Pi;
  for (const Direction& direction : directions)
  {
    least = std::min(least, direction.weight);
  }
  return std::clamp(static_cast<int>(20.0 / std::sqrt(least / Pi)), 16, 512);
}

/// Legendre moments (CapMoments) of the directions' cells, [degree][direction], up to the degree beyond which terms
/// vanish in rounding. The cell of a direction is a cap whose solid angle is the direction's weight.
std::vector<std::vector<double>> MeansByDegree(
  const std::vector<double>& moments, const std::vector<Direction>& directions)
{
  constexpr double Lost = 1e-18;
  std::vector<std::vector<double>> means(moments.size(), std::vector<double>(directions.size()));
  for (std::size_t d = 0; d < directions.size(); ++d)
  {
    const std::vector<double> ofCell = CapMoments(directions[d].weight, static_cast<int>(moments.size()) - 1);
    for (std::size_t l = 0; l < moments.size(); ++l)
    {
      means[l][d] = ofCell[l];
    }
  }
  const auto isLost = [&](std::size_t l) {
    double largest = 0.0;
    for (const double mean : means[l])
    {
      largest = std::max(largest, mean * mean);
    }
    return (2.0 * l + 1.0) * std::abs(moments[l]) * largest < Lost;
  };
  while (means.size() > 1 && isLost(means.size() - 1))
  {
    means.pop_back();
  }
  return means;
}

std::vector<double> CellMeanMatrix(const PhaseFunction& function, const std::vector<Direction>& directions)
{
  const std::vector<double> moments = function.Moments(DegreeOfMeans(directions));
  const std::vector<std::vector<double>> means = MeansByDegree(moments, directions);
  std::vector<double> matrix(directions.size() * directions.size()), scale(means.size());
  for (std::size_t i = 0; i < directions.size(); ++i)
  {
    std::vector<double> cosines;
    for (std::size_t j = 0; j <= i; ++j)
    {
      cosines.push_back(Cosine(directions[i], directions[j]));
    }
    for (std::size_t l = 0; l < means.size(); ++l)
    {
      scale[l] = (2.0 * l + 1.0) / (4.0 * Pi) * moments[l] * means[l][i];
    }
    const std::vector<double> row = LegendreSums(cosines, scale, means);
    for (std::size_t j = 0; j <= i; ++j)
    {
      matrix[i * directions.size() + j] = matrix[j * directions.size() + i] = row[j];
    }
  }
  return matrix;
}

/// Orthonormalises columns in their order (Gram-Schmidt), and omits linearly dependent ones.
Basis Orthonormal(const MatrixXd& columns, const VectorXd& values)
{
  Basis basis = { MatrixXd(columns.rows(), columns.cols()), VectorXd(columns.cols()), {} };
  int kept = 0;
  for (int k = 0; k < columns.cols(); ++k)
  {
    VectorXd column = columns.col(k);
    for (int again = 0; again < 2; ++again) // the second pass removes the rounding errors of the first
    {
      const MatrixXd before = basis.columns.leftCols(kept);
      column -= before * (before.transpose() * column);
    }
    if (column.norm() > Dependent)
    {
      basis.columns.col(kept) = column / column.norm();
      basis.values[kept++] = values[k];
      basis.degrees.push_back(DegreeOfTerm(k));
    }
  }
  basis.columns.conservativeResize(Eigen::NoChange, kept);
  basis.values.conservativeResize(kept);
  return basis;
}

/// Basis of the first `terms` spherical harmonics, with the phase function's moments of their degrees as eigenvalues.
Basis Harmonics(const std::vector<Direction>& directions, const std::vector<double>& moments, int terms)
{
  const VectorXd roots = RootsOfWeights(directions);
  MatrixXd columns(directions.size(), terms);
  VectorXd values(terms);
  for (std::size_t d = 0; d < directions.size(); ++d)
  {
    const std::vector<double> y = SphericalHarmonics(DegreeOfTerm(terms - 1), directions[d].omega);
    for (int k = 0; k < terms; ++k)
    {
      columns(d, k) = roots[d] * y[k];
    }
  }
  for (int k = 0; k < terms; ++k)
  {
    values[k] = moments[DegreeOfTerm(k)];
  }
  return Orthonormal(columns, values);
}

/// Basis of the eigenvectors of a symmetric matrix, largest absolute eigenvalues first.
Basis Eigenvectors(const MatrixXd& matrix)
{
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(matrix);
  std::vector<int> order(matrix.rows());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
    [&](int a, int b) { return std::abs(solver.eigenvalues()[a]) > std::abs(solver.eigenvalues()[b]); });
  Basis basis = { MatrixXd(matrix.rows(), matrix.cols()), VectorXd(matrix.cols()), {} };
  for (std::size_t k = 0; k < order.size(); ++k)
  {
    basis.columns.col(k) = solver.eigenvectors().col(order[k]);
    basis.values[k] = solver.eigenvalues()[order[k]];
  }
  return basis;
}

/// Basis of the eigenvectors of a matrix that is repaired, so that it conserves power and has the exact mean cosine.
/// For this, 1 and omega are made eigenvectors. The eigenvalues on their orthogonal complement are limited to the
/// theoretical maximum (numerics.md, Eq. (D5)).
Basis RepairedEigenvectors(
  const MatrixXd& matrix, const std::vector<Direction>& directions, const std::vector<double>& moments)
{
  const Basis given = Harmonics(directions, moments, std::min<int>(4, directions.size()));
  const MatrixXd others = MatrixXd::Identity(matrix.rows(), matrix.cols()) - given.columns * given.columns.transpose();
  Basis rest = Eigenvectors(others * matrix * others);
  double largest = 0.0;
  for (std::size_t l = 2; l < moments.size(); ++l)
  {
    largest = std::max(largest, std::abs(moments[l]));
  }
  const int free = static_cast<int>(matrix.rows() - given.columns.cols());
  Basis all = { MatrixXd(matrix.rows(), matrix.cols()), VectorXd(matrix.cols()), {} };
  all.columns << given.columns, rest.columns.leftCols(free);
  all.values << given.values, rest.values.head(free).cwiseMax(-largest).cwiseMin(largest);
  return all;
}

/// Fraction of light in the forward peak that `terms` terms cannot represent: the Legendre moment of the degree after
/// the degree of the last term, or 0 if this moment is negative.
double PeakBeyond(const std::vector<double>& moments, int terms)
{
  return std::max(0.0, moments[DegreeOfTerm(terms - 1) + 1]);
}

/// Damps the part of the phase function without the peak: multiplies its eigenvalues of degree l by exp(-s l (l + 1)),
/// with the smallest s for which the sum is nowhere negative. `peak` is the fraction in the peak; it is changed so that
/// the mean cosine stays the same.
void DampNegatives(const VectorXd& roots, double g, Basis& basis, double& peak)
{
  const VectorXd whole = basis.values;
  const double forward = g < 0.0 ? 0.0 : peak;
  const MatrixXd factors = std::sqrt(4.0 * Pi) * roots.cwiseInverse().asDiagonal() * basis.columns;
  const auto damped = [&](double s) {
    VectorXd values = ((whole.array() - forward) / (1.0 - forward)).matrix();
    for (int k = 0; k < values.size(); ++k)
    {
      values[k] *= std::exp(-s * basis.degrees[k] * (basis.degrees[k] + 1));
    }
    return values;
  };
  const auto least = [&](const VectorXd& values) {
    return (factors * values.asDiagonal() * factors.transpose()).minCoeff();
  };
  if (least(((whole.array() - peak) / (1.0 - peak)).matrix()) >= LeastPart)
  {
    return;
  }
  const VectorXd values = damped(LeastDamping([&](double s) { return least(damped(s)); }));
  const auto first = std::find(basis.degrees.begin(), basis.degrees.end(), 1) - basis.degrees.begin();
  const double cosine = first < values.size() ? values[first] : 0.0;
  peak = (g - cosine) / (1.0 - cosine);
  basis.values = (peak + (1.0 - peak) * values.array()).matrix(); // with the peak, as it was
}

Basis BasisOf(const PhaseFunction& function, const std::vector<Direction>& directions,
  const SeparableSettings& settings, const std::vector<double>& moments, const std::vector<double>& matrix)
{
  if (settings.factorisation == PhaseFactorisation::SphericalHarmonics)
  {
    return Harmonics(directions, moments, settings.terms);
  }
  const int count = static_cast<int>(directions.size());
  const VectorXd roots = RootsOfWeights(directions);
  const MatrixXd weighted =
    roots.asDiagonal() * Eigen::Map<const MatrixXd>(matrix.data(), count, count) * roots.asDiagonal();
  return settings.repaired ? RepairedEigenvectors(weighted, directions, function.Moments(64)) : Eigenvectors(weighted);
}
}

std::vector<double> CapMoments(double solidAngle, int degree)
{
  const double away = std::min(solidAngle / (2.0 * Pi), 2.0); // 1 - cosine of the half angle of the cap
  const std::vector<double> p = LegendrePolynomials(degree + 1, 1.0 - away);
  std::vector<double> moments(degree + 1, 1.0);
  for (int l = 1; l <= degree; ++l)
  {
    moments[l] = (p[l - 1] - p[l + 1]) / ((2.0 * l + 1.0) * away);
  }
  return moments;
}

std::vector<double> PhaseMatrix(
  const PhaseFunction& function, const std::vector<Direction>& directions, PhaseSampling sampling)
{
  if (sampling == PhaseSampling::CellMeans)
  {
    return CellMeanMatrix(function, directions);
  }
  std::vector<double> matrix(directions.size() * directions.size());
  for (std::size_t i = 0; i < directions.size(); ++i)
  {
    for (std::size_t j = 0; j <= i; ++j)
    {
      const double value = function.Value(i == j ? 1.0 : Cosine(directions[i], directions[j]));
      matrix[i * directions.size() + j] = matrix[j * directions.size() + i] = value;
    }
  }
  return matrix;
}

double TheoreticalError(const std::vector<double>& moments, int terms)
{
  std::vector<double> squares;
  for (std::size_t l = 0; l < moments.size(); ++l)
  {
    squares.insert(squares.end(), 2 * l + 1, moments[l] * moments[l]);
  }
  std::sort(squares.begin(), squares.end()); // ascending order, so that the sum is accurate
  const std::size_t beyond = squares.size() - std::min<std::size_t>(squares.size(), terms);
  const double tail = std::accumulate(squares.begin(), squares.begin() + beyond, 0.0);
  return std::sqrt(tail / std::accumulate(squares.begin(), squares.end(), 0.0));
}

SeparablePhaseFunction::SeparablePhaseFunction(
  const PhaseFunction& function, std::vector<Direction> directions, SeparableSettings settings)
  : Directions(std::move(directions))
  , MeanCosine(function.MeanCosine())
{
  Check(this->Directions, settings);
  const std::vector<double> moments = function.Moments(DegreeOfTerm(settings.terms - 1) + 1);
  this->Whole = PhaseMatrix(function, this->Directions, settings.sampling);
  Basis basis = BasisOf(function, this->Directions, settings, moments, this->Whole);
  const int count = this->DirectionCount();
  const VectorXd roots = RootsOfWeights(this->Directions);
  if (settings.factorisation == PhaseFactorisation::SingularValues && settings.repaired)
  {
    const MatrixXd repaired = basis.columns * basis.values.asDiagonal() * basis.columns.transpose();
    Eigen::Map<MatrixXd>(this->Whole.data(), count, count) =
      roots.cwiseInverse().asDiagonal() * repaired * roots.cwiseInverse().asDiagonal();
  }
  const bool whole = settings.factorisation == PhaseFactorisation::SingularValues && settings.terms == count;
  this->PeakPart = settings.truncatesPeak && !whole ? PeakBeyond(moments, settings.terms) : 0.0;
  if (settings.nowhereNegative && !basis.degrees.empty())
  {
    DampNegatives(roots, this->MeanCosine, basis, this->PeakPart);
  }
  for (int k = 0; k < basis.values.size(); ++k)
  {
    this->Singular.push_back(std::abs(basis.values[k]));
    const double left = (basis.values[k] - this->PeakPart) / (1.0 - this->PeakPart);
    if (k < settings.terms && std::abs(left) > Nothing * std::abs(basis.values[0]))
    {
      this->Eigenvalues.push_back(left);
      for (int d = 0; d < count; ++d)
      {
        this->Factors.push_back(basis.columns(d, k) / roots[d]);
      }
    }
  }
  std::stable_sort(this->Singular.begin(), this->Singular.end(), std::greater<>());
}

double SeparablePhaseFunction::Value(int i, int j) const
{
  double value = 0.0;
  for (int k = 0; k < this->Terms(); ++k)
  {
    value += this->Eigenvalues[k] * this->Factor(i, k) * this->Factor(j, k);
  }
  return value;
}

double SeparablePhaseFunction::LargestPower() const
{
  double most = 0.0;
  for (int from = 0; from < this->DirectionCount(); ++from)
  {
    double sum = 0.0;
    for (int to = 0; to < this->DirectionCount(); ++to)
    {
      sum += this->Directions[to].weight * this->Value(to, from);
    }
    most = std::max(most, sum);
  }
  return most;
}

std::vector<SeparableErrors> SeparablePhaseFunction::ErrorsByTerms() const
{
  const int count = this->DirectionCount();
  const VectorXd roots = RootsOfWeights(this->Directions);
  const Eigen::Map<const MatrixXd> whole(this->Whole.data(), count, count);
  const double peak = whole.maxCoeff();
  const double all = (roots.asDiagonal() * whole * roots.asDiagonal()).norm();
  MatrixXd cosines(count, count);
  VectorXd weights(count);
  for (int i = 0; i < count; ++i)
  {
    weights[i] = this->Directions[i].weight;
    for (int j = 0; j < count; ++j)
    {
      cosines(i, j) = Cosine(this->Directions[i], this->Directions[j]);
    }
  }
  MatrixXd sum = MatrixXd(weights.cwiseInverse().asDiagonal()) * this->PeakPart;
  std::vector<SeparableErrors> errors;
  for (int k = 0; k < this->Terms(); ++k)
  {
    const Eigen::Map<const VectorXd> u(this->Factors.data() + static_cast<std::size_t>(k) * count, count);
    sum += (1.0 - this->PeakPart) * this->Eigenvalues[k] * u * u.transpose();
    SeparableErrors of;
    of.frobenius = (roots.asDiagonal() * (whole - sum) * roots.asDiagonal()).norm() / all;
    of.maximum = (whole - sum).cwiseAbs().maxCoeff() / peak;
    of.rowSum = ((sum * weights).array() - 1.0).abs().maxCoeff();
    of.meanCosine = ((sum.cwiseProduct(cosines) * weights).array() - this->MeanCosine).abs().maxCoeff();
    of.least = sum.minCoeff() / peak;
    errors.push_back(of);
  }
  return errors;
}
}
