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
/// Uncollided light in each known voxel, i.e. the rank's own voxels and its ghost voxels (LatticeBox): an
/// UncollidedImage and the arrays it refers to.
struct Uncollided
{
  std::vector<float> fluence, netFlux;
  /// Mean positions of collisions relative to the voxels' centres, times fluence, by voxel, channel and face
  /// (LightField::firstMoments), W / length^2; empty: not known.
  std::vector<float> firstMoments;
  UncollidedImage image; ///< `escaped` is set on the lowest rank that has voxels, and 0 on all other ranks
  /// Incident power that neither collided nor escaped, W; set on the same rank as `escaped`.
  Rgb lost = {};

  /// How far the mean position of collisions is displaced from a voxel's centre towards a face, in voxels, 0 to 1/2.
  double Nearer(std::size_t voxel, int channel, std::size_t face) const;
};

/// How far the mean position of collisions of a beam along an axis is displaced upstream from a voxel's centre, in
/// voxels, 0 to 1/2 (numerics.md, Eq. (L14), k = sigma_t h).
double NearerOfNormalBeam(const Medium& medium, std::size_t voxel, int channel);

/// Computes the uncollided light in each known voxel (own or ghost voxel of this rank): the light given by another
/// solver, if there is any, else that of lamps and environment by light propagation maps. Diffuse light of sky and
/// faces is excluded, since it enters the lattice directly. Collective.
Uncollided FindUncollided(
  Device& device, const LatticeProblem& problem, const LatticeSettings& settings, const Monitor& monitor);

/// Computes net flux, if settings ask for it, and first moments of uncollided light from the mean directions of its
/// image.
/// @param firstMoments  whether first moments are computed
void AddMomentsOfImage(
  Uncollided& found, const LatticeProblem& problem, const LatticeSettings& settings, bool firstMoments);
}
