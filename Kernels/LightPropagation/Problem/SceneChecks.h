#pragma once

#include "Distribution/Domain.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <string>

namespace tyndall
{
/// @throws InvalidInput what Check() of the three throw, where a face that gives back light lies across a periodic
///   axis, and where light could not end: all faces give back all of it and nothing absorbs
void Check(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);
/// The same of a medium of which each rank has its block; ranks must agree on all but their voxels. Collective.
/// @throws InvalidInput  also where `medium` has not the size of its block
void Check(
  const Domain& domain, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);

/// The same of a medium that is one of several blocks, but for what only all of them tell: whether light ends.
void CheckBlock(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);
/// Whether light ends in a medium, and whether it begins there: is emitted, or scattered of lamps within or of light
/// that is given. By channel, in any voxel.
struct LightEnds
{
  std::array<bool, 3> absorbs = {}, begins = {};
};
LightEnds LightEndsIn(const Medium& medium, const Illumination& illumination);
/// @throws InvalidInput where light can neither leave the box nor be absorbed, and goes on until it does
void RequireSink(const LightEnds& ends, const Illumination& illumination, const PropagationSettings& settings);

/// All ranks call it together.
/// @throws InvalidInput  on each, where they differ in what all must have alike of a scene
/// @param has  voxels; without any the medium is not looked at
void RequireSame(Communicator& communicator, bool has, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings);

/// LightEndsIn of the medium of all ranks. All ranks call it together.
LightEnds LightEndsOnAny(Communicator& communicator, bool has, const Medium& medium, const Illumination& illumination);
}
