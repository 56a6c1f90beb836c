#pragma once

#include "LightPropagation/PropagationSettings.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Degree of the angular moments to solve a medium with: the settings', or by its phase function where they leave it
/// open; no more than the directions tell apart. 0 where scattering is isotropic.
/// @param slab  plane-parallel: more moments cost little
int AngularDegreeFor(const Medium& medium, const PropagationSettings& settings, bool slab);
}
