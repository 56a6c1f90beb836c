#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "Light/LightField.h"
#include "Lights/Lights.h"
#include "Medium/Field.h"
#include "Medium/Medium.h"
#include "Photons/Photons.h"

#include <vector>

namespace tyndall
{
/// Lattice-Boltzmann lighting (Geist et al. 2004; Bernabei et al., section III-C; numerics.md, section 10 c): photon
/// density in each voxel along its links to neighbours, which collides there and moves on, until it is steady.
/// Uncollided light is that of the illumination's image (UncollidedImage), or else that of lamps and environment, found
/// along the maps' rays; what is scattered of it, what the medium emits, and the light of sky and faces diffuse.
///
/// Conservative: collisions are scaled so that densities are positive and power is kept for any optical thickness of a
/// voxel: where it is above 4/3 mean free paths, links give back a part. Light that crosses into a lower refractive
/// index goes back as far as it would be reflected totally, so that fluence over n^2 diffuses, and a furnace stays n^2;
/// sky and faces shine with their radiance times n^2. The steady state is solved for (SteadyLattice.h), unless steps
/// are asked for.
/// As published: the explicit collisions of the paper, without refraction. Densities swing and grow where sigma_t h is
/// above 1; a doubt says so.
///
/// It is diffusion: wrong where light is not scattered often, and anisotropic scattering counts by the similarity
/// relation. In thick voxels, by the conservative scheme, light begins where it is first scattered: that of lamps where
/// their rays say (Eq. (L13)), that of an UncollidedImage where its mean directions and the next voxels say (Eq.
/// (L14)), and in the middle of voxels where it has none.
///
/// @param ior  refractive index by voxel; null values: 1
/// @throws InvalidInput where voxels are not cubes (to 0.1%), an index is not positive and finite (names the first such
///   voxel), or what Check() of medium, illumination and settings say; where steps as published grew beyond floats
/// @throws DeviceError where it does not fit; Aborted
LightField SolveLatticeBoltzmann(Device& device, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings, const Monitor& monitor = {});

/// The same of the light of photons, which march along bent rays to where they are first scattered (PhotonMarcher), as
/// uncollided light: to their ends before light diffuses, or beside it (InterleavedLattice.h), as settings say. Of
/// `illumination` what is diffuse and faces' albedo count, and no lamp.
/// @throws InvalidInput where an axis is periodic, or what PhotonMarcher says; and as above
LightField SolveLatticeBoltzmann(Device& device, const Medium& medium, const Field& ior,
  const std::vector<Photon>& photons, const Illumination& illumination, const LatticeSettings& settings,
  const Monitor& monitor = {});
}
