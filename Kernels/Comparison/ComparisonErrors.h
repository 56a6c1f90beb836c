#pragma once

#include "Comparison/ComparisonRow.h"

#include <vector>

namespace tyndall
{
/// Sets `pareto` of each row that no other row for the same quantity dominates, i.e. is at least as fast and as
/// accurate, and better in one of both. Rows without an error are not marked.
void MarkPareto(std::vector<ComparisonRow>& rows);

struct RelativeErrors
{
  double l2 = 0.0, max = 0.0, relative = 0.0;
};
/// Errors as defined in ComparisonRow. Voxels in which the reference is NaN are skipped; the result is NaN if no voxel
/// is left or the reference is zero.
RelativeErrors ErrorsOf(const std::vector<float>& light, const std::vector<float>& reference);
}
