#pragma once

#include "Distribution/Domain.h"
#include "LightPropagation/PropagationSettings.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <string>

namespace tyndall
{
/// Checks that a scene can be solved.
/// @throws InvalidInput  if Check() of medium, illumination or settings throws, if a reflecting face lies across a
/// periodic axis, or if light has no sink: all faces reflect completely and nothing absorbs
void Check(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);
/// The same for a distributed medium, of which each rank has its block. All ranks must agree on everything except their
/// voxels. Collective.
/// @throws InvalidInput  also if `medium` has not the size of its block
void Check(
  const Domain& domain, const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);

/// The same for one block of a medium, except the test for a sink, which needs all blocks.
void CheckBlock(const Medium& medium, const Illumination& illumination, const PropagationSettings& settings);
/// Sinks and sources of light within a medium, by channel. absorbs: any voxel absorbs. begins: any voxel emits, or
/// scatters light of lamps inside the box or uncollided light that is given as input.
struct LightEnds
{
  std::array<bool, 3> absorbs = {}, begins = {};
};
LightEnds LightEndsIn(const Medium& medium, const Illumination& illumination);
/// @throws InvalidInput  if there is light that can neither leave the box nor be absorbed
void RequireSink(const LightEnds& ends, const Illumination& illumination, const PropagationSettings& settings);

/// All ranks call it together.
/// @throws InvalidInput  on every rank, if ranks differ in inputs that must be identical
/// @param has  this rank's block has voxels; otherwise its medium is not read
void RequireSame(Communicator& communicator, bool has, const Medium& medium, const Illumination& illumination,
  const PropagationSettings& settings);

/// LightEndsIn() for the media of all ranks together. Collective.
LightEnds LightEndsOnAny(Communicator& communicator, bool has, const Medium& medium, const Illumination& illumination);
}
