#include "LightPropagation/Problem/UnvaryingAxes.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr double Width =
  10.0; ///< width in edges of the other axes; larger ones gain little, and flat voxels slow down the diffusion solve
constexpr int EdgeInSlabs = 12;
/// An even number of rows with directions of cosine 0, whose light would wrap around forever
constexpr int EdgeWithCosineZero = 10;

bool AnyIsNear(const std::vector<Light>& lights)
{
  return std::any_of(
    lights.begin(), lights.end(), [](const Light& light) { return light.type != LightType::Directional; });
}
}

UnvaryingAxes::UnvaryingAxes(const Grid& grid, const Illumination& illumination, const PropagationSettings& settings)
{
  if (settings.source == PropagationSource::Constant || AnyIsNear(SeenFrom(grid, illumination.lights)))
  {
    return;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Single[axis] = grid.size[axis] == 1 && settings.periodic[axis];
  }
}

Grid UnvaryingAxes::Widened(const Grid& grid) const
{
  double width = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    width = std::max(width, this->Single[axis] ? 0.0 : Width * grid.spacing[axis]);
  }
  Grid wide = grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    wide.spacing[axis] = this->Single[axis] && width > 0.0 ? width : grid.spacing[axis];
  }
  return wide;
}

int DirectionsPerFaceFor(const PropagationSettings& settings, const UnvaryingAxes& unvarying)
{
  const int told = settings.directionsPerFace;
  const int edge = static_cast<int>(std::lround(std::sqrt(static_cast<double>(std::max(told, 0)))));
  if (settings.source == PropagationSource::Constant || !settings.adaptDirections || edge * edge != told)
  {
    return told;
  }
  const bool goRound = settings.periodic[0] + settings.periodic[1] + settings.periodic[2] == 2;
  const int even = goRound || unvarying.IsSlab() ? edge + edge % 2 : edge;
  const bool stays = goRound && even == EdgeWithCosineZero;
  const int enough = unvarying.IsSlab() || stays ? std::max(even, EdgeInSlabs) : even;
  return enough * enough;
}
}
