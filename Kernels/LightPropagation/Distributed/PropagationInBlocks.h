#pragma once

#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Problem/SceneChecks.h"

namespace tyndall
{
inline LightField SolveInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings,
  const Monitor& monitor = {}, KeptLight* kept = nullptr)
{
  return SolveConservative(device, Domain(communicator, partition), medium, illumination, settings, monitor, kept);
}

inline PropagationSettings AtQualityInBlocks(Communicator& communicator, const BlockPartition& partition,
  Quality quality, const PropagationSettings& settings, const Medium& medium, const Illumination& illumination)
{
  return AtQuality(Domain(communicator, partition), quality, settings, medium, illumination);
}

inline std::string ReasonNotToDecompose(Device& device, Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const Illumination& illumination, const PropagationSettings& settings)
{
  return ReasonNotToDecompose(device, Domain(communicator, partition), medium, illumination, settings);
}
}
