#pragma once

#include "LatticeBoltzmann/LatticeBox.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Medium.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// Distance, 0 to 1/2 voxel, from the voxel's centre upstream to the mean collision place of a beam along an axis
/// (numerics.md, Eq. (L14), k = sigma_t h).
double NearerOfNormalBeam(const Medium& medium, std::size_t voxel, int channel);

/// Estimate of the first moments of collisions (LightField::firstMoments) for uncollided light that is known by voxel
/// only: along its mean direction it decays as exp(-k x), where k follows from the fluence of the next voxel downstream
/// (numerics.md, Eq. (L14)). Empty if the image has no mean direction.
std::vector<float> EstimatedFirstMoments(const UncollidedImage& image, const Medium& medium, const LatticeBox& box);
}
