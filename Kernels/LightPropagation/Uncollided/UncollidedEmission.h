#pragma once

#include "LightPropagation/Uncollided/EmissionRays.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <utility>

namespace tyndall
{
/// The uncollided flux of a small bright part of the medium, along exact rays (EmissionRays.h).
class UncollidedEmission : public UncollidedSource
{
public:
  /// @param error  as DepositEmission takes it
  UncollidedEmission(EmissionPeak peak, double error)
    : Peak(std::move(peak))
    , Error(error)
  {
  }

  SweepTally AddTo(
    Device& device, const SweepVolume& volume, int firstChannel, SweepWorkspace&, const Monitor& monitor) const override
  {
    return DepositEmission(device, volume, firstChannel, this->Peak, this->Error, monitor);
  }

private:
  EmissionPeak Peak;
  double Error;
};
}
