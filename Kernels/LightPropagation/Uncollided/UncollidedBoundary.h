#pragma once

#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <functional>

namespace tyndall
{
/// Sweeps once along a set of directions of its own, in parts whose rays fit into memory. By blocks all ranks call it.
/// @param isLit  whether anything comes along a direction
/// @param source  as SweepOperator takes it, with the moments of the volume's basis; null: the medium is dark
/// @param incoming  may be none
SweepTally SweepAlong(const UncollidedVolume& volume, const SweptDirections& along,
  const std::function<bool(int)>& isLit, const Buffer<float>* source, const SweepBoundary& incoming,
  const Monitor& monitor);

/// The uncollided flux of shining faces, sky and environment, along a set of directions of its own, swept once. Shadows
/// have edges, which need many directions; scattered light, which is swept every order, is smooth and needs few.
class UncollidedBoundary : public UncollidedSource
{
public:
  /// @param settings, light  must stay
  UncollidedBoundary(const PropagationSettings& settings, const BoundaryLight& light);

  SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const override;

private:
  const PropagationSettings& Settings;
  const BoundaryLight& Light;
};
}
