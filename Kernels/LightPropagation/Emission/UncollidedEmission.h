#pragma once

#include "LightPropagation/Emission/EmissionPeaks.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

namespace tyndall
{
/// The uncollided flux of a small bright part of the medium, along exact rays (EmissionRays.h).
class UncollidedEmission : public UncollidedSource
{
public:
  /// @param error  as DepositEmission takes it
  UncollidedEmission(EmissionPeak peak, double error);

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;

private:
  SweepTally Put(const UncollidedVolume& volume, const Monitor& monitor) const;

  EmissionPeak Peak;
  double Error;
};
}
