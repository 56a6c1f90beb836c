#pragma once

#include "Lights/Lights.h"

#include <vector>

class vtkPolyData;

namespace tyndall
{
/// A light, and the size of its shape in a view.
struct DrawnLight
{
  Light light;         ///< the light, drawn at its position even if it is directional
  double length = 1.0; ///< length of the light's arrow or cone, or radius of its ball; above 0
};

/// Draws the shapes of lights for a view: an arrow along the direction of a directional light, a ball for a point
/// light, the outline of the cone of a spot light, and a rectangle with an arrow on the emitting side for a rectangle
/// light. The lights must be valid: callers check them by Check of Lights.h.
/// @param shapes  receives lines and polygons, and point array `color` (red, green, blue as bytes, active scalars): the
///   light's colour at full brightness
void DrawLights(const std::vector<DrawnLight>& lights, vtkPolyData* shapes);
}
