#include "LightPropagation/Emission/UncollidedEmission.h"

#include "LightPropagation/Emission/EmissionRays.h"
#include "LightPropagation/Uncollided/NarrowLight.h"

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
  if (!volume.basis)
  {
    return this->Put(volume, monitor);
  }
  const NarrowLight light(volume, true);
  UncollidedVolume apart = volume;
  apart.deposit = light.To();
  const SweepTally tally = this->Put(apart, monitor);
  light.AddAlongFlux();
  return tally;
}

SweepTally UncollidedEmission::Put(const UncollidedVolume& volume, const Monitor& monitor) const
{
  const auto add = [this, &volume](const SweepVolume& ofChannels, int first, const Monitor& ofGroup) {
    return DepositEmission(volume.device, ofChannels, first, this->Peak, this->Error, ofGroup);
  };
  return AddByGroups(volume, monitor, add);
}
}
