#pragma once

#include "Distribution/Domain.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// Checks that a scene can be solved. Collective.
/// @param medium  of this rank's block; not read on a rank without voxels
/// @throws InvalidInput  if Check() of medium, illumination or settings throws, if the medium does not have the size of
///   its block, if a reflecting face lies across a periodic axis, from RequireSame, or from RequireSink
void Check(
  const Domain& domain, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);

/// @throws InvalidInput  on every rank, if ranks differ in anything except their voxels. Collective.
void RequireSame(
  const Domain& domain, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);

/// @throws InvalidInput  on every rank, if there is light that can neither leave the box nor be absorbed. Collective.
void RequireSink(
  const Domain& domain, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);
}
