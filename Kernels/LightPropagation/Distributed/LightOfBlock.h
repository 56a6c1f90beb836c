#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Conservative/Iteration.h"
#include "LightPropagation/Distributed/BlockOnDevice.h"
#include "LightPropagation/Distributed/IncidentLight.h"
#include "LightPropagation/Problem/ScatteringOrders.h"

namespace tyndall
{
/// The light of one rank's block, in the solver's units, when an iteration has ended: that of its voxels, with the
/// powers and the convergence of all ranks. All ranks call it together.
/// @param block  its Path is written over
/// @param found  is used up
/// @param how  orders were added up
LightField LightOfBlock(
  BlockOnDevice& block, const IncidentLight& incident, IterationResult&& found, IterationScheme how);
}
