#include "PhaseFunction/DeltaM.h"

#include <algorithm>

namespace tyndall
{
DeltaM::DeltaM(const std::vector<double>& all)
  : forward(all.back())
  , moments(all.begin(), all.end() - 1)
{
  if (this->moments.size() > 1)
  {
    // Only a forward peak is treated as unscattered, and the remaining moments must be valid, i.e. in [-1, 1].
    this->forward = std::max(this->forward, 0.0);
    for (double moment : this->moments)
    {
      this->forward = std::min(this->forward, 0.5 * (1.0 + moment));
    }
  }
  for (double& moment : this->moments)
  {
    moment = (moment - this->forward) / (1.0 - this->forward);
  }
}

std::vector<DeltaM> Truncations(const PhaseFunction& function, int degree)
{
  const std::vector<double> moments = function.Moments(degree + 1);
  std::vector<DeltaM> truncations;
  for (int l = 0; l <= degree; ++l)
  {
    truncations.emplace_back(std::vector<double>(moments.begin(), moments.begin() + l + 2));
  }
  return truncations;
}
}
