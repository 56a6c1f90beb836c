#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Published/PublishedModel.h"
#include "Lights/UncollidedImage.h"

#include <functional>
#include <vector>

namespace tyndall
{
/// Moments of light that another solver found, voxel by voxel.
/// @param add  is told what to add to a moment of a voxel and channel
void AddGiven(const PublishedModel& model, const UncollidedImage& image, std::size_t voxels,
  const std::function<void(std::size_t moment, std::size_t voxel, int channel, double value)>& add);

/// Fluence, scattered radiance and, where it is asked for, net flux from the moments of all orders.
/// @param moment  of a number, by voxel with channels interleaved
void TakeMoments(
  const PublishedModel& model, bool netFlux, const std::function<std::vector<float>(int)>& moment, LightField& field);
}
