#pragma once

#include "Comparison/ComparisonRow.h"

#include <vector>

namespace tyndall
{
/// Sets `pareto`: where no other row that is compared with the same quantity is both at least as fast and at least as
/// good, and one of both better. Rows without an error have none.
void MarkPareto(std::vector<ComparisonRow>& rows);

struct RelativeErrors
{
  double l2 = 0.0, max = 0.0, relative = 0.0;
};
/// See ComparisonRow. Voxels in which the reference is NaN do not count; NaN where there are none or the reference is
/// dark.
RelativeErrors ErrorsOf(const std::vector<float>& light, const std::vector<float>& reference);
}
