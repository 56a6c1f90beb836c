#include "Viewing/Sources/Aureole.h"

#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"
#include "Viewing/Scene/ViewShared.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr int MostMoments = 1024;
constexpr double Negligible = 1e-5; ///< Legendre moments below this are dropped

/// The highest degree that was solved for: straightOn is the moment of the next degree. Returns `otherwise` if
/// straightOn equals no moment, as for functions that scatter backwards.
int DegreeOf(const std::vector<double>& moments, double straightOn, int otherwise)
{
  for (std::size_t l = 1; l < moments.size() && straightOn > 0.0; ++l)
  {
    if (std::abs(moments[l] - straightOn) <= 1e-4 * straightOn)
    {
      return static_cast<int>(l) - 1;
    }
  }
  return otherwise;
}

/// Legendre moments of the light that was scattered at least twice, per unit of the unscattered beam's light and per
/// optical length of scattering.
std::vector<double> MomentsBeyondFirst(const std::vector<double>& moments, double straightOn, int degree, double depth)
{
  std::vector<double> beyond;
  for (std::size_t l = 0; l < moments.size(); ++l)
  {
    const double more = moments[l] - straightOn;
    const double grows = depth > 0.0 ? std::expm1(more * depth) / depth : more;
    beyond.push_back(static_cast<int>(l) <= degree ? -straightOn * straightOn : moments[l] * (grows - straightOn));
  }
  return beyond;
}

double CosineOfColumn(int column)
{
  const double aside = 2.0 * std::min(column, AureoleColumns - column) / AureoleColumns;
  return 2 * column < AureoleColumns ? 1.0 - aside * aside : aside * aside - 1.0;
}
}

std::vector<float> AureoleTable(const PhaseFunction& function, double straightOn, int degree)
{
  std::vector<double> moments = function.Moments(MostMoments);
  const int solved = DegreeOf(moments, straightOn, degree);
  while (moments.size() > 1 && std::abs(moments.back()) < Negligible)
  {
    moments.pop_back();
  }
  std::vector<std::vector<double>> polynomials;
  for (int column = 0; column < AureoleColumns + 2; ++column)
  {
    polynomials.push_back(
      LegendrePolynomials(static_cast<int>(moments.size()) - 1, CosineOfColumn(std::min<int>(column, AureoleColumns))));
  }
  std::vector<float> table;
  for (int row = 0; row < AureoleRows + 2; ++row)
  {
    const double root = std::min<double>(row, AureoleRows) / AureoleRows;
    const std::vector<double> beyond = MomentsBeyondFirst(moments, straightOn, solved, AureoleDepth * root * root);
    for (const std::vector<double>& p : polynomials)
    {
      double sum = 0.0;
      for (std::size_t l = 0; l < beyond.size(); ++l)
      {
        sum += (2.0 * l + 1.0) * beyond[l] * p[l];
      }
      table.push_back(static_cast<float>(sum / (4.0 * Pi)));
    }
  }
  return table;
}
}
