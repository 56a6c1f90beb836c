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
  OrdersAdded how = OrdersAdded::OneByOne;
  std::array<int, 3> halvings = {}; ///< of cells, where orders are added up by these
};

/// As HowOrdersAreAdded has it of the whole, with isotropic scattering; the same on all ranks, which call it together.
OrdersOverRanks HowOrdersAreAdded(Communicator& communicator, const BlockPartition& partition, const BlockScene& scene,
  const PropagationSettings& settings);
}
