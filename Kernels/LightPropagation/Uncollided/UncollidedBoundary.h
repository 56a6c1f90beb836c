#pragma once

#include "LightPropagation/Uncollided/BoundaryLight.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

namespace tyndall
{
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
