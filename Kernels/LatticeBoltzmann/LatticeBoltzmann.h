#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Field.h"
#include "Medium/Medium.h"

#include <array>

namespace tyndall
{
/// How light diffuses on a lattice.
struct LatticeSettings
{
  /// Neighbours that a voxel exchanges light with: 18 (Geist et al. 2004), or 6 along the axes.
  int directions = 18;
  int maximumSteps = 0;    ///< 0: as many as the tolerance takes
  double tolerance = 1e-4; ///< relative error of fluence at which to stop, estimated
  std::array<bool, 3> periodic = {};
};

/// @throws InvalidInput where there are not 6 or 18 directions, steps are negative or the tolerance is not positive
void Check(const LatticeSettings& settings);

/// Lattice-Boltzmann lighting (Geist et al. 2004; Bernabei et al., section III-C; numerics.md, section 10 c): photon
/// density in each voxel along its links to neighbours, which collides there and moves on, until it is steady.
/// Uncollided light is that of the illumination's image (UncollidedImage), or else that of lamps and environment, found
/// along the maps' rays; what is scattered of it, what the medium emits, and the light of sky and faces diffuse.
///
/// Collisions are scaled so that densities are positive and power is kept for any optical thickness of a voxel: where
/// it is above 4/3 mean free paths, links give back a part. Light that crosses into a lower refractive index goes back
/// as far as it would be reflected totally, so that fluence over n^2 diffuses, and a furnace stays n^2.
///
/// It is diffusion: wrong where light is not scattered often, and anisotropic scattering counts by the similarity
/// relation.
///
/// @param ior  refractive index by voxel; null values: 1
/// @throws InvalidInput where voxels are not cubes (to 0.1%), or what Check() of medium and illumination say
/// @throws DeviceError where it does not fit; Aborted
LightField SolveLatticeBoltzmann(Device& device, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings, const Monitor& monitor = {});
}
