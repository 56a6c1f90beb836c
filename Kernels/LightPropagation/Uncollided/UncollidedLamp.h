#pragma once

#include "LightPropagation/Uncollided/UncollidedSource.h"
#include "Lights/Lights.h"

namespace tyndall
{
/// Uncollided flux of one lamp along exact rays: parallel rays for a directional light (ParallelBeam.cl), else rays
/// from a point (LampBeams.h).
class UncollidedLamp : public UncollidedSource
{
public:
  explicit UncollidedLamp(const Light& lamp); ///< `lamp` must outlive this object
  const Light& TheLight() const { return this->Lamp; }

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;

private:
  SweepTally Put(const UncollidedVolume& volume, const Monitor& monitor) const;

  const Light& Lamp;
};
}
