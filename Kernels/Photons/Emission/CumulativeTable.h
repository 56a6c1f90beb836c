#pragma once

#include <algorithm>

namespace tyndall
{
/// Inverts a cumulative table: the step at which the fraction u of the total is reached. Never returns a step of zero
/// height.
/// @param table  count + 1 non-decreasing values, the first 0, the last above 0
/// @param u      [0, 1)
/// @param part   output: position within that step, [0, 1)
inline int FindStep(const double* table, int count, double u, double& part)
{
  const double wanted = u * table[count];
  int step = static_cast<int>(std::upper_bound(table + 1, table + count, wanted) - table) - 1;
  while (table[step + 1] == table[step]) // if rounding raised `wanted` to the total
  {
    --step;
  }
  part = std::min(
    // Keeps step + part below step + 1 after rounding.
    (wanted - table[step]) / (table[step + 1] - table[step]), 1.0 - 0x1p-40);
  return step;
}
}
