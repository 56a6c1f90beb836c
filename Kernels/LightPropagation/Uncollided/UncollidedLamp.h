#pragma once

#include "LightPropagation/Uncollided/LampBeams.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

namespace tyndall
{
/// The uncollided flux of one lamp, along exact rays (LampBeams.h).
class UncollidedLamp : public UncollidedSource
{
public:
  UncollidedLamp(const Light& lamp, const std::array<bool, 3>& periodic)
    : Lamp(lamp)
    , Periodic(periodic)
  {
  }

  SweepTally AddTo(Device& device, const SweepVolume& volume, int firstChannel, SweepWorkspace& workspace,
    const Monitor& monitor) const override
  {
    Light ofChannels = this->Lamp;
    ofChannels.power = From(this->Lamp.power, firstChannel);
    return DepositLamp(device, volume, ofChannels, this->Periodic, workspace, monitor);
  }

private:
  Light Lamp;
  std::array<bool, 3> Periodic;
};
}
