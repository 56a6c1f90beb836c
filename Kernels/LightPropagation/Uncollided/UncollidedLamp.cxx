#include "LightPropagation/Uncollided/UncollidedLamp.h"

#include "LightPropagation/Uncollided/LampBeams.h"
#include "LightPropagation/Uncollided/ParallelBeam.h"

namespace tyndall
{
UncollidedLamp::UncollidedLamp(const Light& lamp, const std::array<bool, 3>& periodic)
  : Lamp(lamp)
  , Periodic(periodic)
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
    return DepositBeam(volume, this->Lamp, this->Periodic, monitor);
  }
  const auto add = [this, &volume](const SweepVolume& ofChannels, int first, const Monitor& ofGroup) {
    Light light = this->Lamp;
    light.power = From(this->Lamp.power, first);
    return Sum(light.power) > 0.0 ? DepositLamp(volume.device, ofChannels, light, this->Periodic, ofGroup)
                                  : SweepTally();
  };
  return AddByGroups(volume, monitor, add);
}
}
