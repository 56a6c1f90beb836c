#include "Reference/KobayashiReference.h"

#include "Reference/ReferenceTable.h"

std::vector<KobayashiReference> KobayashiProblem1()
{
  std::vector<KobayashiReference> points;
  for (const ReferenceRow& row : ReadReference("kobayashi_problem1"))
  {
    points.push_back({ { row["x"], row["y"], row["z"] }, row["own_i"], row["mean10_i"], row["mean3_i"], row["own_ii"],
      row["own_ii_std"], row["pub_ii"], row["re_ii"] });
  }
  return points;
}
