#pragma once

#include "LightPropagation/Conservative/Iteration.h"
#include "LightPropagation/Distributed/Balance/AccelerationInBlocks.h"
#include "LightPropagation/Distributed/BlockOnDevice.h"
#include "LightPropagation/Distributed/IncidentLight.h"
#include "LightPropagation/Distributed/UncollidedOverRanks.h"

namespace tyndall
{
/// Iteration with diffusion acceleration (AccelerationInBlocks.h) on one rank's block, in step with the others: light
/// of lamps goes ahead, and what of it is scattered is given to the sweeps.
class IterationByBalance : public Iteration
{
public:
  /// @param block, incident, uncollided  must stay; without finer directions
  /// @param kept  light of the last solve (WarmStart.h), must stay; null, on all ranks: none, and none is to be kept
  IterationByBalance(BlockOnDevice& block, const IncidentLight& incident, UncollidedOverRanks& uncollided,
    const KeptLight* kept = nullptr);
  /// All ranks call it.
  IterationResult Run(const Monitor& monitor) override;

private:
  void MakeShown(IterationResult& result);
  SweepTally AddNearFaces(AccelerationInBlocks& acceleration, const Buffer<float>& shown, const Monitor& monitor);
  void FindShown(AccelerationInBlocks& acceleration, const Buffer<float>& shown);

  BlockOnDevice& Block;
  const IncidentLight& Incident;
  UncollidedOverRanks& Uncollided;
  const KeptLight* const Kept;
};
}
