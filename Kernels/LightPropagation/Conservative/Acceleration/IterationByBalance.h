#pragma once

#include "LightPropagation/Conservative/Acceleration/AccelerationInBlocks.h"
#include "LightPropagation/Conservative/Iteration.h"
#include "LightPropagation/Conservative/TransportParts.h"

namespace tyndall
{
/// Iteration with diffusion acceleration (AccelerationInBlocks.h) on several ranks: light of lamps goes ahead, and what
/// of it is scattered is given to the sweeps. Made and run collectively.
class IterationByBalance : public Iteration
{
public:
  /// @param parts  must stay; without finer directions
  /// @param kept  light of the last solve (WarmStart.h), must stay; null, on all ranks: none, and none is to be kept
  explicit IterationByBalance(TransportParts& parts, const KeptLight* kept = nullptr);
  IterationResult Run(const Monitor& monitor) override;

private:
  void MakeShown(IterationResult& result);
  SweepTally AddUncollided(AccelerationInBlocks& acceleration, const Buffer<float>& shown, const Monitor& monitor);
  void FindShown(AccelerationInBlocks& acceleration, const Buffer<float>& shown);

  TransportParts& Parts;
  const TransportParts::Sources Lamps;
  const KeptLight* const Kept;
};
}
