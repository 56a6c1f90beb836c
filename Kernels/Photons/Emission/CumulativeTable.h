#pragma once

#include <algorithm>

namespace tyndall
{
/// The step of a cumulative table in which u of the whole is reached. Steps of no height are never found.
/// @param table  count + 1 numbers from 0 on that do not fall; the last is above 0
/// @param u      [0, 1)
/// @param part   where in that step, [0, 1)
inline int FindStep(const double* table, int count, double u, double& part)
{
  const double wanted = u * table[count];
  int step = static_cast<int>(std::upper_bound(table + 1, table + count, wanted) - table) - 1;
  while (table[step + 1] == table[step]) // where u times the whole was rounded up to it
  {
    --step;
  }
  part = std::min(
    (wanted - table[step]) / (table[step + 1] - table[step]), 1.0 - 0x1p-40); // the sum with step stays below the next
  return step;
}
}
