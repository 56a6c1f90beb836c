#include "LightPropagation/Angular/SweptDirections.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace tyndall
{
namespace
{
/// Returns the representative of the class of directions that carry the same light as `omega` (DirectionSymmetry). Its
/// components along periodic axes of one voxel (`single`) are positive and, for equal spacings, in decreasing order.
std::array<double, 3> Standard(std::array<double, 3> omega, const Grid& grid, const std::array<bool, 3>& single)
{
  for (int a = 0; a < 3; ++a)
  {
    omega[a] = single[a] ? std::abs(omega[a]) : omega[a];
  }
  for (const std::array<int, 2>& pair : { std::array<int, 2>{ 0, 1 }, { 1, 2 }, { 0, 2 }, { 0, 1 } })
  {
    const bool same = single[pair[0]] && single[pair[1]] && grid.spacing[pair[0]] == grid.spacing[pair[1]];
    if (same && omega[pair[0]] < omega[pair[1]])
    {
      std::swap(omega[pair[0]], omega[pair[1]]);
    }
  }
  return omega;
}
}

DirectionSymmetry::DirectionSymmetry(const Grid& grid, const std::array<bool, 3>& periodic, const DirectionSet& set)
  : ClassOf(set.directions.size())
{
  std::array<bool, 3> single;
  for (int a = 0; a < 3; ++a)
  {
    single[a] = periodic[a] && grid.size[a] == 1;
  }
  // Index of each class of directions that carry the same light; key: representative of the class. Keys are compared
  // bit by bit, which suffices because mirror images in a quadrature agree to the last bit.
  std::map<std::array<double, 3>, int> numbers;
  for (std::size_t d = 0; d < set.directions.size(); ++d)
  {
    const std::array<double, 3> standard = Standard(set.directions[d].omega, grid, single);
    const auto [found, isNew] = numbers.insert({ standard, static_cast<int>(this->Classes.size()) });
    if (isNew)
    {
      this->Classes.emplace_back();
    }
    std::vector<int>& all = this->Classes[found->second];
    all.insert(standard == set.directions[d].omega ? all.begin() : all.end(), static_cast<int>(d));
    this->ClassOf[d] = found->second;
  }
}

std::vector<Bundle> DirectionSymmetry::Standing(const std::vector<Bundle>& bundles) const
{
  std::vector<Bundle> standing;
  for (const Bundle& bundle : bundles)
  {
    // Representative members (directions) of the bundle; key: number of directions in their class, which carry the same
    // light
    std::map<std::size_t, std::vector<Member>> parts;
    for (Member member : bundle.members)
    {
      member.direction = this->IsRepresentative(member.direction) ? member.direction : -1;
      member.opposite = this->IsRepresentative(member.opposite) ? member.opposite : -1;
      const int any = std::max(member.direction, member.opposite);
      if (any >= 0)
      {
        parts[this->AllOf(any).size()].push_back(member);
      }
    }
    for (const auto& [all, members] : parts)
    {
      Bundle part = bundle;
      part.members = members;
      part.power *= static_cast<double>(all);
      standing.push_back(part);
    }
  }
  return standing;
}

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
