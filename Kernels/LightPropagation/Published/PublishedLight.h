#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Published/PublishedModel.h"

#include <functional>
#include <vector>

namespace tyndall
{
/// Fluence, scattered radiance and, where it is asked for, net flux from the moments of all orders.
/// @param moment  of a number, by voxel with channels interleaved
void TakeMoments(
  const PublishedModel& model, bool netFlux, const std::function<std::vector<float>(int)>& moment, LightField& field);
}
