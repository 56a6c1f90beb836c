#include "LightPropagation/Angular/AngularValues.h"

namespace tyndall
{
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
