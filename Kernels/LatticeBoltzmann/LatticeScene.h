#pragma once

#include "LightPropagation/Problem/PropagationProblem.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

namespace tyndall
{
/// A scene in the units and channels that a lattice solves it in. What it sees must stay.
struct LatticeScene
{
  const Medium& medium; ///< of the known voxels (LatticeBox.h)
  const Illumination& shining;
  int channels; ///< 1 or 3
};

inline LatticeScene SceneOf(const PropagationProblem& problem)
{
  return { problem.TheMedium(), problem.Shining(), problem.Channels() };
}
}
