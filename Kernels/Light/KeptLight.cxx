#include "Light/KeptLight.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
std::string LightKind::WhatChangedSince(const LightKind& last) const
{
  return this->size != last.size || this->spacing != last.spacing ? "the grid has changed"
    : this->block.first != last.block.first || this->block.size != last.block.size
    ? "the blocks that the grid is cut into have changed"
    : this->channels != last.channels     ? "the number of channels has changed"
    : this->degree != last.degree         ? "the degree of angular moments has changed"
    : this->periodic != last.periodic     ? "the periodic axes have changed"
    : this->directions != last.directions ? "the directions have changed"
    : this->method != last.method         ? "the light was found by " + last.method
                                          : std::string();
}

std::string WhyNotBegun(const KeptLight& kept, const LightKind& kind, int maximumOrders)
{
  return maximumOrders > 0 ? "MaximumOrders counts iterations from darkness on"
    : kept.Empty()         ? "there is none"
                           : kind.WhatChangedSince(kept.kind);
}

void Keep(KeptLight&& left, bool warm, LightField& light, KeptLight& kept)
{
  kept = std::move(left);
  if (!warm)
  {
    kept.fromDarkness = light.convergence;
  }
  light.sweepsSaved.assign(light.convergence.size(), 0);
  for (std::size_t i = 0; i < light.convergence.size() && warm; ++i)
  {
    const double residual = light.convergence[i].residual;
    const auto asGood = std::find_if(kept.fromDarkness.begin(), kept.fromDarkness.end(),
      [residual](const ConvergenceRow& row) { return row.residual <= residual; });
    light.sweepsSaved[i] = static_cast<int>(asGood - kept.fromDarkness.begin()) - static_cast<int>(i);
  }
}

std::string WordsOfWarmStart(const std::string& whyNot)
{
  return whyNot.empty() ? "scattering orders from darkness on: begun from the last light (WarmStart)"
                        : "the last light as a first guess (WarmStart): " + whyNot;
}
}
