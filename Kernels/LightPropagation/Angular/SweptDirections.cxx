#include "LightPropagation/Angular/SweptDirections.h"

#include <utility>

namespace tyndall
{
SweptDirections::SweptDirections(
  const Grid& grid, const PropagationSettings& settings, DirectionSet set, RayStarts starts)
  : TheGrid(grid)
  , Periodic(settings.periodic)
  , MapResolution(settings.mapResolution)
  , Directions(std::move(set))
  , WhereRaysStart(starts)
  , Mirrors(grid, settings.periodic, this->Directions)
  , Merges(settings.leaveOut && !settings.netFlux)
{
}

std::vector<int> SweptDirections::AllOf(int direction) const
{
  return this->Merges ? this->Mirrors.AllOf(direction) : std::vector<int>{ direction };
}

std::vector<Bundle> SweptDirections::Along(int axis) const
{
  const std::vector<Bundle> bundles =
    BundlesAlong(axis, this->TheGrid, this->Periodic, this->Directions, this->MapResolution, this->WhereRaysStart);
  return this->Merges ? this->Mirrors.Standing(bundles) : bundles;
}

std::vector<Bundle> SweptDirections::LitAlong(int axis, int way, const std::function<bool(int)>& isLit) const
{
  return LitRays(this->Along(axis), way, isLit);
}
}
