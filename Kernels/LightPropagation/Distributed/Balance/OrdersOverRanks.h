#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LightPropagation/Distributed/BlockScene.h"
#include "LightPropagation/Problem/ScatteringOrders.h"
#include "LightPropagation/PropagationSettings.h"

#include <array>

namespace tyndall
{
/// How scattering orders of a medium that is spread over ranks are added up.
struct OrdersOverRanks
{
  IterationScheme how = IterationScheme::SourceIteration;
  IterationScheme ofWhole = IterationScheme::SourceIteration; ///< of the same medium in one memory
  std::array<int, 3> halvings = {};                           ///< of cells, where orders are added up by these
  double needed = 0.0; ///< OrdersNeeded; 0 where neither acceleration nor uncollidedDirections are left open
};

/// As ChooseIterationScheme has it of the whole, as far as blocks can; the same on all ranks, which call it together.
OrdersOverRanks ChooseIterationScheme(Communicator& communicator, const BlockPartition& partition,
  const BlockScene& scene, const PropagationSettings& settings);
}
