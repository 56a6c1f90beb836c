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

AngularValues SweptDirections::Values(const AngularBasis& basis) const
{
  AngularValues values;
  values.degree = basis.Degree();
  for (std::size_t d = 0; d < this->Directions.directions.size(); ++d)
  {
    const std::vector<int> all = this->AllOf(static_cast<int>(d));
    std::vector<double> mean(basis.Count(), 0.0);
    for (int direction : all)
    {
      const std::vector<double> here = basis.At(this->Directions.directions[direction].omega);
      for (int i = 0; i < basis.Count(); ++i)
      {
        mean[i] += here[i] / static_cast<double>(all.size());
      }
    }
    values.functions.push_back(mean);
  }
  return values;
}

double SweptDirections::Mean(int direction, const std::vector<double>& values) const
{
  const std::vector<int> all = this->AllOf(direction);
  double sum = 0.0;
  for (int one : all)
  {
    sum += values[one];
  }
  return sum / static_cast<double>(all.size());
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
