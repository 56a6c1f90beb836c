#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"
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
/// Uncollided light is that of the illumination's image (UncollidedImage), or else that of lamps and environment by
/// light propagation maps; its first-collision source, emission, and incident light of sky and faces diffuse.
///
/// Conservative: collisions are scaled so that densities are positive and power is kept for any optical thickness of a
/// voxel: where it is above 4/3 mean free paths, links give back a part. Light that crosses into a lower refractive
/// index is returned as far as it would be reflected totally, so that fluence over n^2 diffuses, and a furnace stays
/// n^2; sky and faces are incident with their radiance times n^2. The steady state is solved for (SteadyLattice.h),
/// unless steps are asked for. As published: the explicit collisions of the paper, without refraction. Densities swing
/// and grow where sigma_t h is above 1; a warning says so.
///
/// It is diffusion: wrong where light is not scattered often, and anisotropic scattering counts by the similarity
/// relation. In thick voxels the conservative scheme resolves where light is first scattered: that of lamps by first
/// moments of their rays (Eq. (L13)), that of an UncollidedImage by its mean directions and the next voxels (Eq.
/// (L14)), or in the middle of voxels if it has none.
///
/// Over ranks each solves its block with two layers of ghost voxels, the steady state only; the light is that of one
/// rank to the tolerance (numerics.md, section 10 c). Collective.
///
/// @param medium, ior, illumination  of the rank's block, with the grid domain.OwnGrid(); not read where that has no
///   voxels. ior: refractive index by voxel; null values: 1
/// @param settings  the same on all ranks
/// @return arrays of the block; balance, face powers and convergence of all ranks
/// @throws InvalidInput over ranks with settings that take steps (NotInBlocks) or differ; where voxels are not cubes
///   (to 0.1%), an index is not positive and finite (names the first such voxel), or what Check() of medium,
///   illumination and settings say; where steps as published overflowed
/// @throws DeviceError where it does not fit; Aborted
LightField SolveLatticeBoltzmann(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings, const Monitor& monitor = {});

/// The same with photons, which march along bent rays to where they are first scattered (PhotonMarcher), as uncollided
/// light: to their ends before light diffuses, or beside it (InterleavedLattice.h), as settings say. Of `illumination`
/// diffuse light and the faces' albedo count, and no lamp.
/// @param photons  a share of them: all are those of rank 0, then those of rank 1, and so on
/// @throws InvalidInput if an axis is periodic, or what PhotonMarcher says; and as above
LightField SolveLatticeBoltzmann(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const std::vector<Photon>& photons, const Illumination& illumination, const LatticeSettings& settings,
  const Monitor& monitor = {});
}
