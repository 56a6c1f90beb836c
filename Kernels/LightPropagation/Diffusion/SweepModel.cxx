#include "LightPropagation/Diffusion/SweepModel.h"

#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"

#include <algorithm>

namespace tyndall
{
namespace
{
int OtherAxis(int axis, int which)
{
  const PlaneAxes axes = AcrossAxis(axis);
  return which == 0 ? axes.u : axes.v;
}

double FaceArea(const Grid& grid, int axis)
{
  return grid.spacing[(axis + 1) % 3] * grid.spacing[(axis + 2) % 3];
}

/// Power per area that the rays that march along the axis `marching` carry, at radiance 1, through voxel faces
/// perpendicular to `axis` towards increasing index: one value for each plane of voxels perpendicular to `marching`.
std::vector<double> CrossingsIn(
  const Grid& grid, const DirectionSet& set, int mapResolution, RayStarts starts, int axis, int marching)
{
  const int planes = grid.size[marching];
  const bool isU = AcrossAxis(marching).u == axis;
  std::vector<double> power(planes, 0.0);
  for (const Bundle& bundle : BundlesAlong(marching, grid, {}, set, mapResolution, starts))
  {
    for (int k = 0; k < planes; ++k)
    {
      const PlaneCrossing crossing = bundle.Crossing(k);
      for (int s = 1; s < crossing.count; ++s)
      {
        for (const Member& member : bundle.members)
        {
          const int fromU = isU ? member.uFromU : member.vFromU;
          const int fromV = isU ? member.uFromV : member.vFromV;
          const int move = fromU * crossing.segments[s].moveU + fromV * crossing.segments[s].moveV;
          if (move > 0)
          {
            const double crosses = crossing.segments[s].part * bundle.power / FaceArea(grid, axis);
            power[k] += crosses;
            power[planes - 1 - k] += crosses;
          }
        }
      }
    }
  }
  return power;
}

constexpr int Cosines = 4; ///< number of Gauss points for the integral over the cosine, numerics.md, Eq. (51)
}

double HalfRange(const DirectionSet& set, int axis)
{
  double sum = 0.0;
  for (const Direction& direction : set.directions)
  {
    sum += direction.weight * std::max(direction.omega[axis], 0.0);
  }
  return sum;
}

double HalfRange(const Grid& grid, const DirectionSet& set, int axis, int marching)
{
  double sum = 0.0;
  for (const Direction& direction : set.directions)
  {
    sum += PartMarching(grid, direction.omega, marching) * direction.weight * std::max(direction.omega[axis], 0.0);
  }
  return sum;
}

CrossingPattern FindCrossingPattern(
  const Grid& grid, const DirectionSet& set, int mapResolution, RayStarts starts, const std::array<bool, 3>& periodic)
{
  CrossingPattern pattern;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double straight = HalfRange(grid, set, axis, axis);
    double all = straight;
    for (int which = 0; which < 2; ++which)
    {
      all += HalfRange(grid, set, axis, OtherAxis(axis, which));
    }
    for (int which = 0; which < 2; ++which)
    {
      const int marching = OtherAxis(axis, which);
      // Along a periodic axis rays wrap around many times, so the same power crosses the faces in each plane: the mean
      // over all planes.
      const std::vector<double> power = periodic[marching]
        ? std::vector<double>(grid.size[marching], HalfRange(grid, set, axis, marching))
        : CrossingsIn(grid, set, mapResolution, starts, axis, marching);
      pattern.first[2 * axis + which] = static_cast<int>(pattern.values.size());
      for (double crossing : power)
      {
        pattern.values.push_back(static_cast<float>((crossing + (which == 0 ? straight : 0.0)) / all));
      }
    }
  }
  return pattern;
}

SweepModel ModelOfRays(const Grid& grid, const SweptDirections& directions, const std::array<bool, 3>& periodic)
{
  SweepModel model;
  model.halfRange = HalfRange(directions.Set(), 0) / (4.0 * Pi);
  model.pattern = FindCrossingPattern(grid, directions.Set(), directions.RaysPerEdge(), directions.Starts(), periodic);
  const GaussLegendre rule(Cosines);
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int k = 0; k < Cosines; ++k)
    {
      const double cosine = 0.5 * (1.0 + rule.points[k]);
      model.flatSource[axis].push_back({ static_cast<float>(cosine), static_cast<float>(grid.spacing[axis] / cosine),
        static_cast<float>(0.25 * rule.weights[k] * cosine) });
    }
  }
  return model;
}
}
