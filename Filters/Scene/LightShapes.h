#pragma once

#include "Lights/Lights.h"

#include <vector>

class vtkPolyData;

namespace tyndall
{
/// A light together with the size at which it is drawn.
struct DrawnLight
{
  Light light;         ///< drawn at its position, even if directional
  double length = 1.0; ///< length of its arrow or cone, or radius of a point light; above 0
};

/// Draws the shapes of lights for a view: an arrow along the direction of a directional light, a ball for a point
/// light, the outline of its cone for a spot light, and a rectangle with an arrow on its emitting side for a rectangle
/// light.
/// @param shapes  receives lines and polygons, and point array `color` (red, green, blue as bytes, active scalars): the
///   light's colour at full brightness
/// @throws nothing; check the lights before (Check in Lights.h)
void DrawLights(const std::vector<DrawnLight>& lights, vtkPolyData* shapes);
}
