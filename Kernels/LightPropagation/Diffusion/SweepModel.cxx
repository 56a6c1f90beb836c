#include "LightPropagation/Diffusion/SweepModel.h"

#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"

namespace tyndall
{
namespace
{
constexpr int Cosines = 4; ///< number of Gauss points for the integral over the cosine, numerics.md, Eq. (51)
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
