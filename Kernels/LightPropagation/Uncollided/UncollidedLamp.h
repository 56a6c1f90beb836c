#pragma once

#include "LightPropagation/Uncollided/UncollidedSource.h"
#include "Lights/Lights.h"

namespace tyndall
{
/// The uncollided flux of one lamp, along exact rays: parallel ones (ParallelBeam.h) or those of a point (LampBeams.h).
class UncollidedLamp : public UncollidedSource
{
public:
  UncollidedLamp(const Light& lamp, const std::array<bool, 3>& periodic);

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;

private:
  Light Lamp;
  std::array<bool, 3> Periodic;
};
}
