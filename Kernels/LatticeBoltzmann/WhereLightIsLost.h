#pragma once

#include "LatticeBoltzmann/LatticeBox.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Medium.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// Distance, 0 to 1/2 voxel, of the mean place where a beam along an axis collides from the voxel's middle, upstream
/// (numerics.md, Eq. (L14), k = sigma_t h).
double NearerOfNormalBeam(const Medium& medium, std::size_t voxel, int channel);

/// First moments (LightField::firstMoments) of collisions of light that is known by voxel only: along its mean
/// direction it falls off as exp(-k x), and k follows from the fluence of the next voxel downstream (numerics.md, Eq.
/// (L14)). Empty if the image has no mean direction.
std::vector<float> EstimatedFirstMoments(const UncollidedImage& image, const Medium& medium, const LatticeBox& box);
}
