#include "Viewing/Aureole.h"

#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"
#include "Viewing/ViewShared.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr int MostMoments = 1024;
constexpr double Negligible = 1e-5; ///< moment

/// Of each degree: what was scattered at least twice, over the light of the beam that comes straight on.
std::vector<double> MomentsBeyondFirst(const std::vector<double>& moments, double straightOn, double depth)
{
  std::vector<double> beyond;
  bool within = true; // the degrees that are solved for, where what goes straight on is left out alone
  for (const double moment : moments)
  {
    within = within && moment > straightOn * (1.0 + 1e-6);
    beyond.push_back(within ? -straightOn * straightOn * depth
                            : moment * (std::expm1((moment - straightOn) * depth) - straightOn * depth));
  }
  return beyond;
}

double CosineOfColumn(int column)
{
  const double aside = 2.0 * std::min(column, AureoleColumns - column) / AureoleColumns;
  return 2 * column < AureoleColumns ? 1.0 - aside * aside : aside * aside - 1.0;
}
}

std::vector<float> AureoleTable(const PhaseFunction& function, double straightOn)
{
  std::vector<double> moments = function.Moments(MostMoments);
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
    const std::vector<double> beyond = MomentsBeyondFirst(moments, straightOn, AureoleDepth * root * root);
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
