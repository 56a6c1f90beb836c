#pragma once

#include "Lights/UncollidedImage.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Distance, 0 to 1/2, of the mean place where exp(-k x), x from 0 to 1, is lost from the middle, towards where it
/// comes from (numerics.md, Eq. (L14)).
double NearerBy(double k);

/// Where in voxels light is lost that is known by voxel alone, as LightField::firstMoments has it, of the image's
/// channels: light that comes along its mean direction falls off as exp(-k x), and k is told by the fluence of the next
/// voxel on its way (numerics.md, Eq. (L14)). Empty where the image has no mean direction.
std::vector<float> EstimatedFirstMoments(
  const UncollidedImage& image, const Medium& medium, const std::array<bool, 3>& periodic);
}
