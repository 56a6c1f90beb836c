#include "LightPropagation/Uncollided/UncollidedLamp.h"

#include "LightPropagation/Uncollided/Lamps/LampBeams.h"
#include "LightPropagation/Uncollided/NarrowLight.h"
#include "LightPropagation/Uncollided/ParallelBeam.h"
#include "Numerics/Vectors.h"

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

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
  if (!volume.basis)
  {
    return this->Put(volume, monitor);
  }
  const bool parallel = this->Lamp.type == LightType::Directional;
  const NarrowLight light(volume, !parallel);
  UncollidedVolume apart = volume;
  apart.deposit = light.To();
  const SweepTally tally = this->Put(apart, monitor);
  if (parallel)
  {
    const glm::dvec3 along = glm::normalize(Vector(this->Lamp.direction));
    light.AddAlong({ along.x, along.y, along.z });
  }
  else
  {
    light.AddAlongFlux();
  }
  return tally;
}

/// Path integrals, flux and first moments, no angular moments.
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
    return volume.followLamp ? volume.followLamp(ofChannels, light, ofGroup)
                             : DepositLamp(volume.device, ofChannels, light, volume.periodic, ofGroup);
  };
  return AddByGroups(volume, monitor, add);
}
}
