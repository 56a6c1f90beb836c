#pragma once

#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <functional>

namespace tyndall
{
/// Sweeps once along a quadrature of its own, in batches whose rays fit into memory. Collective if the grid is divided
/// into blocks.
/// @param isLit  whether a direction carries any light
/// @param source  as for SweepOperator, with the moments of the volume's basis; null: no emission
/// @param incoming  boundary source; may be empty
SweepTally SweepAlong(const UncollidedVolume& volume, const SweptDirections& along,
  const std::function<bool(int)>& isLit, const Buffer<float>* source, const SweepBoundary& incoming,
  const Monitor& monitor);

/// The uncollided flux of emitting faces, sky and environment, from one sweep along a quadrature of its own. Shadow
/// edges need many directions; scattered light, which is swept every order, is smooth and needs few.
class UncollidedBoundary : public UncollidedSource
{
public:
  /// @param settings, light  must outlive this object
  UncollidedBoundary(const PropagationSettings& settings, const BoundaryLight& light);

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;

private:
  const PropagationSettings& Settings;
  const BoundaryLight& Light;
};
}
