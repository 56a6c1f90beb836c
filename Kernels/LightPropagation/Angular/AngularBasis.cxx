#include "LightPropagation/Angular/AngularBasis.h"

#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"

#include <cmath>

namespace tyndall
{
namespace
{
/// Values of SphericalHarmonics() at `omega`, scaled so that the square of each averages to 1 over all directions.
std::vector<double> Harmonics(int degree, const std::array<double, 3>& omega)
{
  std::vector<double> values = SphericalHarmonics(degree, omega);
  for (double& value : values)
  {
    value *= std::sqrt(4.0 * Pi);
  }
  return values;
}

/// A function is accepted if at least this fraction of its squared norm remains after the previous functions have been
/// projected out.
constexpr double LeastLeft = 0.3;

/// Orthonormalises the spherical harmonics on a quadrature, one function after another (Gram-Schmidt). A row has the
/// coefficients of one orthonormal function.
/// @return as many rows as are well-conditioned on the quadrature
std::vector<std::vector<double>> Orthonormal(const DirectionSet& set, int degree)
{
  const int count = (degree + 1) * (degree + 1);
  std::vector<std::vector<double>> values(count), rows;
  for (const Direction& direction : set.directions)
  {
    const std::vector<double> here = Harmonics(degree, direction.omega);
    for (int i = 0; i < count; ++i)
    {
      values[i].push_back(here[i]);
    }
  }
  const auto product = [&](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0.0;
    for (std::size_t d = 0; d < a.size(); ++d)
    {
      sum += set.directions[d].weight * a[d] * b[d] / (4.0 * Pi);
    }
    return sum;
  };
  for (int i = 0; i < count; ++i)
  {
    std::vector<double> row(count, 0.0);
    row[i] = 1.0;
    for (int j = 0; j < i; ++j)
    {
      // A second pass removes the rounding errors of the first one. Functions of different parity are exactly
      // orthogonal and are skipped.
      for (int pass = 0; pass < 2 && AngularBasis::IsOdd(i) == AngularBasis::IsOdd(j); ++pass)
      {
        const double part = product(values[i], values[j]);
        for (std::size_t d = 0; d < values[i].size(); ++d)
        {
          values[i][d] -= part * values[j][d];
        }
        for (int k = 0; k <= j; ++k)
        {
          row[k] -= part * rows[j][k];
        }
      }
    }
    const double left = product(values[i], values[i]);
    if (!(left > LeastLeft))
    {
      break;
    }
    for (double& value : values[i])
    {
      value /= std::sqrt(left);
    }
    for (double& factor : row)
    {
      factor /= std::sqrt(left);
    }
    rows.push_back(row);
  }
  return rows;
}
}

int AngularBasis::DegreeOf(int function)
{
  return DegreeOfTerm(function);
}

int AngularBasis::OrderOf(int function)
{
  const int l = DegreeOf(function);
  return function - l * l - l;
}

std::array<bool, 3> AngularBasis::IsOdd(int function)
{
  const int l = DegreeOf(function), m = OrderOf(function);
  const bool oddM = m % 2 != 0;
  return { m >= 0 ? oddM : !oddM, m < 0, (l + m) % 2 != 0 };
}

AngularBasis::AngularBasis(const DirectionSet& set, int degree)
  : L(degree)
  , Rows(Orthonormal(set, degree))
{
}

std::vector<double> AngularBasis::Matrix() const
{
  std::vector<double> matrix;
  for (const std::vector<double>& row : this->Rows)
  {
    matrix.insert(matrix.end(), row.begin(), row.end());
  }
  return matrix;
}

std::vector<double> AngularBasis::At(const std::array<double, 3>& omega) const
{
  const std::vector<double> harmonics = Harmonics(this->L, omega);
  std::vector<double> values(this->Rows.size(), 0.0);
  for (std::size_t i = 0; i < this->Rows.size(); ++i)
  {
    for (std::size_t j = 0; j <= i; ++j)
    {
      values[i] += this->Rows[i][j] * harmonics[j];
    }
  }
  return values;
}

int MostDegree(const DirectionSet& set, int wanted)
{
  const std::size_t told = Orthonormal(set, wanted).size();
  int degree = 0;
  while (static_cast<std::size_t>((degree + 2) * (degree + 2)) <= told)
  {
    ++degree;
  }
  return degree;
}

FunctionOrder::FunctionOrder(int degree, int u, int v)
{
  for (int parity = 0; parity < 4; ++parity)
  {
    for (int i = 0; i < (degree + 1) * (degree + 1); ++i)
    {
      const std::array<bool, 3> odd = AngularBasis::IsOdd(i);
      if (odd[u] + 2 * odd[v] == parity)
      {
        this->functions.push_back(i);
        ++this->counts[parity];
      }
    }
  }
}
}
