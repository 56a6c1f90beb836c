#include "Comparison/ComparisonErrors.h"

// Error measures of the rows of a comparison; see SolverComparison.h.

#include <algorithm>
#include <cmath>

namespace tyndall
{
RelativeErrors ErrorsOf(const std::vector<float>& light, const std::vector<float>& reference)
{
  double differences = 0.0, squares = 0.0, farthest = 0.0, largest = 0.0, relative = 0.0;
  std::size_t lit = 0;
  for (std::size_t i = 0; i < reference.size(); ++i)
  {
    if (std::isnan(reference[i]))
    {
      continue;
    }
    const double difference = std::abs(static_cast<double>(light[i]) - reference[i]);
    differences += difference * difference;
    squares += static_cast<double>(reference[i]) * reference[i];
    if (reference[i] > 0.0f)
    {
      relative += std::pow(difference / reference[i], 2.0);
      ++lit;
    }
    // Not std::max, so that NaN propagates.
    farthest = difference <= farthest ? farthest : difference;
    largest = std::max(largest, static_cast<double>(reference[i]));
  }
  return squares > 0.0 ? RelativeErrors{ std::sqrt(differences / squares), farthest / largest,
    std::sqrt(relative / static_cast<double>(lit)) }
                       : RelativeErrors{ ComparisonRow::Unknown, ComparisonRow::Unknown, ComparisonRow::Unknown };
}

void MarkPareto(std::vector<ComparisonRow>& rows)
{
  const auto beats = [](const ComparisonRow& a, const ComparisonRow& b) {
    return IsDirectOnly(a.method) == IsDirectOnly(b.method) && a.seconds <= b.seconds && a.errorL2 <= b.errorL2 &&
      (a.seconds < b.seconds || a.errorL2 < b.errorL2);
  };
  for (ComparisonRow& row : rows)
  {
    row.pareto = std::isfinite(row.errorL2) && std::isfinite(row.seconds) &&
      std::none_of(rows.begin(), rows.end(), [&](const ComparisonRow& other) { return beats(other, row); });
  }
}
}
