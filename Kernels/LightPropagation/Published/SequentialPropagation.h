#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Published/PublishedModel.h"

#include "Device/Monitor.h"

namespace tyndall
{
constexpr const char* SequentialDevice = "host, one core"; ///< value of LightField::device for SolveSequential()

/// Solves by light propagation maps as published, Algorithm 1 of Gruson et al. 2012 (Fattal 2009): one ray after the
/// other on one core (numerics.md, section 3). It is the reference for the result and the speed of the parallel
/// algorithm. Exponentials are computed in double precision by the standard library; radiance is float.
///
/// Memory: host only, about one float per voxel, channel, and source direction or moment.
/// @throws InvalidInput if medium, illumination or settings are invalid
/// @throws Aborted if the monitor requests it
LightField SolveSequential(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings,
  const Monitor& monitor = {});
}
