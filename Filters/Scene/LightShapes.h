#pragma once

#include "Lights/Lights.h"

#include <vector>

class vtkPolyData;

namespace tyndall
{
/// How large one light is drawn.
struct DrawnLight
{
  Light light;         ///< drawn at its position, also a directional light
  double length = 1.0; ///< of its arrow or cone; a point light's radius. Above 0
};

/// Shapes of lights for a view: an arrow along its direction for a directional light, a ball for a point light, the
/// outline of its cone for a spot, and for a rectangle itself with an arrow on the side that emits.
/// @param shapes  gets lines and polygons, and point array `color` (bytes of red, green, blue, active scalars): that
///   of the light at full brightness
/// @throws nothing; lights are to be checked before (Check of Lights.h)
void DrawLights(const std::vector<DrawnLight>& lights, vtkPolyData* shapes);
}
