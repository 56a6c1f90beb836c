#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeProblem.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Lights/Rgb.h"
#include "Lights/UncollidedImage.h"
#include "Medium/Medium.h"

#include <cstddef>
#include <vector>

namespace tyndall
{
/// Uncollided light by known voxel: an image and the arrays it refers to.
struct Uncollided
{
  std::vector<float> fluence, netFlux;
  std::vector<float> firstMoments; ///< LightField::firstMoments, for the image's channels; empty: not known
  UncollidedImage image;           ///< `escaped` is set on the lowest rank that has voxels, 0 on others
  Rgb lost = {};                   ///< power that entered and was not deposited anywhere, W; set on the same rank

  /// Distance, 0 to 1/2 voxel, from a voxel's centre towards a face to the mean place where its light collides.
  double Nearer(std::size_t voxel, int channel, std::size_t face) const;
};

/// Distance, 0 to 1/2 voxel, from the voxel's centre upstream to the mean collision place of a beam along an axis
/// (numerics.md, Eq. (L14), k = sigma_t h).
double NearerOfNormalBeam(const Medium& medium, std::size_t voxel, int channel);

/// Uncollided light by known voxel: that of another solver if given, else that of lamps and environment by light
/// propagation maps. Diffuse sky and face light is excluded; it is incident on the lattice itself. Collective.
Uncollided FindUncollided(
  Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const Monitor& monitor);

/// Adds net flux and first moments, if asked for, to uncollided light that is given as an image with mean directions.
/// @param firstMoments  whether first moments are asked for
void AddMomentsOfImage(
  Uncollided& found, const LatticeProblem& problem, const LatticeSettings& settings, bool firstMoments);
}
