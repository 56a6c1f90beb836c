#pragma once

#include "Lights/UncollidedImage.h"
#include "Medium/Medium.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Distance, 0 to 1/2 voxel, from a cube's middle towards where a beam along an axis comes from of the mean place where
/// its light is lost (numerics.md, Eq. (L14), k = sigma_t h).
double NearerOfNormalBeam(const Medium& medium, std::size_t voxel, int channel);

/// Where in voxels light is lost that is known by voxel alone, as LightField::firstMoments has it, of the image's
/// channels: light that comes along its mean direction falls off as exp(-k x), and k is told by the fluence of the next
/// voxel on its way (numerics.md, Eq. (L14)). Empty where the image has no mean direction.
std::vector<float> EstimatedFirstMoments(
  const UncollidedImage& image, const Medium& medium, const std::array<bool, 3>& periodic);
}
