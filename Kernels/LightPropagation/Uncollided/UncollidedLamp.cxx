#include "LightPropagation/Uncollided/UncollidedLamp.h"

#include "LightPropagation/Uncollided/LampBeams.h"
#include "LightPropagation/Uncollided/ParallelBeam.h"

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
  if (this->Lamp.type == LightType::Directional)
  {
    return DepositBeam(volume, this->Lamp, monitor);
  }
  const auto add = [this, &volume](const SweepVolume& ofChannels, int first, const Monitor& ofGroup) {
    Light light = this->Lamp;
    light.power = OfGroup(this->Lamp.power, first);
    return Sum(light.power) > 0.0 ? DepositLamp(volume.device, ofChannels, light, volume.periodic, ofGroup)
                                  : SweepTally();
  };
  return AddByGroups(volume, monitor, add);
}
}
