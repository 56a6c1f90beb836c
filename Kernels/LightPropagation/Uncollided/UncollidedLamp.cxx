#include "LightPropagation/Uncollided/UncollidedLamp.h"

#include "LightPropagation/Uncollided/Lamps/LampBeams.h"
#include "LightPropagation/Uncollided/NarrowLight.h"
#include "LightPropagation/Uncollided/ParallelBeam.h"

#include <optional>

namespace tyndall
{
UncollidedLamp::UncollidedLamp(const Light& lamp)
  : Lamp(lamp)
{
}

SweepTally UncollidedLamp::AddTo(const UncollidedVolume& volume, const Monitor& monitor) const
{
  if (Sum(this->Lamp.power) == 0.0)
  {
    return {};
  }
  const bool parallel = this->Lamp.type == LightType::Directional;
  std::optional<NarrowLight> light;
  volume.domain.Collective([&] { // a rank without voxels has no basis, and no light of its own
    if (volume.basis)
    {
      light.emplace(volume, !parallel);
    }
  });
  UncollidedVolume apart = volume;
  apart.deposit = light ? light->To() : volume.deposit;
  const SweepTally tally = this->Put(apart, monitor);
  if (light && parallel)
  {
    light->AddAlong(DirectionOf(this->Lamp));
  }
  else if (light)
  {
    light->AddAlongFlux();
  }
  return tally;
}

/// Deposits path integrals, flux and first moments, but no angular moments.
SweepTally UncollidedLamp::Put(const UncollidedVolume& volume, const Monitor& monitor) const
{
  if (this->Lamp.type == LightType::Directional)
  {
    return DepositBeam(volume, this->Lamp, monitor);
  }
  const auto add = [this, &volume](const SweepVolume& ofChannels, int first, const Monitor& ofGroup) {
    Light light = this->Lamp;
    light.power = OfGroup(this->Lamp.power, first);
    if (Sum(light.power) == 0.0)
    {
      return SweepTally();
    }
    return DepositLamp(volume.device, volume.domain, ofChannels, light, volume.periodic, ofGroup);
  };
  return AddByGroups(volume, monitor, add);
}
}
