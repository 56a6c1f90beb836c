#pragma once

#include "LightPropagation/PlaneParallel/SlabColumn.h"

#include <vector>

namespace tyndall
{
/// LightField::scatteredMoments of a column, [layer][(degree + 1)^2], from the radiance at the nodes, which excludes
/// uncollided light of beams.
std::vector<double> ScatteredMoments(
  const SlabScene& scene, const SlabColumn& column, const HalfRangeQuadrature& nodes, int degree);
}
