#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Published/PublishedModel.h"

#include "Device/Monitor.h"

namespace tyndall
{
constexpr const char* SequentialDevice = "host, one core"; ///< LightField::device

/// Light propagation maps as published, Algorithm 1 of Gruson et al. 2012 (Fattal 2009): one ray after the other on one
/// core (numerics.md, section 3). The reference that the parallel algorithm is compared with, and the baseline of its
/// speed. Exponentials are the library's, in double; radiance is float.
///
/// Memory: host only, about (sources + moments) floats a voxel and channel.
/// @throws InvalidInput for a medium, illumination or settings without meaning; Aborted
LightField SolveSequential(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings,
  const Monitor& monitor = {});
}
