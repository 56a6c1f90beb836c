#pragma once

#include "Lights/Lights.h"
#include "Medium/Grid.h"

#include <array>

namespace tyndall
{
/// Fraction of the power of a point, spot or rectangle lamp that enters the box, in closed form (numerics.md, section
/// 5.3); 0 if unknown: for a spot that is not outside the box or whose cone is too narrow for doubles, and for a
/// rectangle too far away.
double EnteringFraction(const Light& light, const Grid& grid, const std::array<bool, 3>& periodic);
}
