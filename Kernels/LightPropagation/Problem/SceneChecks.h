#pragma once

#include "Distribution/Domain.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Checks that a scene can be solved. Collective.
/// @param medium  medium of this rank's subdomain; not read on a rank without voxels
/// @throws InvalidInput  if Check() of medium, illumination or settings throws, if the medium does not have the size of
///   its subdomain, if a reflecting face is normal to a periodic axis, from RequireSame, or from RequireSink
void Check(
  const Domain& domain, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);

/// Checks that all ranks have the same scene except for the values of voxels. Collective.
/// @throws InvalidInput  on every rank, if ranks differ in anything else
void RequireSame(
  const Domain& domain, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);

/// Checks that light can be absorbed or leave the box. Collective.
/// @throws InvalidInput  on every rank, if any light can do neither
void RequireSink(
  const Domain& domain, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);
}
