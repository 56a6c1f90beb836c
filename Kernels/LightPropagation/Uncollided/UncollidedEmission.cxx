#include "LightPropagation/Uncollided/UncollidedEmission.h"

#include "LightPropagation/Uncollided/EmissionRays.h"

#include <utility>

namespace tyndall
{
UncollidedEmission::UncollidedEmission(EmissionPeak peak, double error)
  : Peak(std::move(peak))
  , Error(error)
{
}

SweepTally UncollidedEmission::AddTo(const UncollidedVolume& volume, const Monitor& monitor) const
{
  const auto add = [this, &volume](const SweepVolume& ofChannels, int first, const Monitor& ofGroup) {
    return DepositEmission(volume.device, ofChannels, first, this->Peak, this->Error, ofGroup);
  };
  return AddByGroups(volume, monitor, add);
}
}
