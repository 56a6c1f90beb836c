#pragma once

#include "LightPropagation/PlaneParallel/SlabColumn.h"

#include <vector>

namespace tyndall
{
/// LightField::scatteredMoments of a column, [layer][(degree + 1)^2], of what a solve without the uncollided light of
/// beams has at the nodes.
std::vector<double> ScatteredMoments(
  const SlabScene& scene, const SlabColumn& column, const HalfRangeQuadrature& nodes, int degree);
}
