#pragma once

#include "Lights/Lights.h"

#include <vector>

class vtkPolyData;

namespace tyndall
{
/// How large one light is drawn.
struct DrawnLight
{
  Light light;         ///< drawn where its position is, a directional light, too
  double length = 1.0; ///< of its arrow or cone; a point light's radius. Above 0
};

/// What lights look like in a view: a directional light is an arrow from its position along its direction, a point
/// light a ball, a spot the outline of its cone, a rectangle itself with an arrow to the side that it shines to.
/// @param shapes  gets lines and polygons, and point array `color` (bytes of red, green, blue, active scalars): that
///   of the light at full brightness
/// @throws nothing; lights are to be checked before (Check of Lights.h)
void DrawLights(const std::vector<DrawnLight>& lights, vtkPolyData* shapes);
}
