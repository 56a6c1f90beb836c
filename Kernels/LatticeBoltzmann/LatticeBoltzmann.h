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
/// densities along the links between neighbouring voxels collide and stream until they are steady. Sources of the
/// lattice are the first-collision source of uncollided light, emission, and diffuse light incident from sky and faces.
/// Uncollided light is given by the illumination (UncollidedImage), or computed by light propagation maps for lamps and
/// environment.
///
/// Conservative scheme: collisions are scaled so that densities are positive and power is conserved for any optical
/// thickness of a voxel; in voxels thicker than 4/3 mean free paths (with 18 links), links reflect a fraction of the
/// light. Light that crosses into a lower refractive index is partly returned, according to total internal reflection,
/// so that fluence / n^2 diffuses, and is uniform in thermal equilibrium. Light of sky and faces is incident with its
/// radiance times n^2. The steady state is solved for directly (SteadyLattice.h), unless the settings request lattice
/// steps. Published scheme: the explicit collisions of the paper, without refraction. Densities oscillate and grow
/// where sigma_t h is above 1; a warning says so.
///
/// The result is a diffusion approximation: inaccurate where light is scattered rarely, with anisotropic scattering
/// treated by the similarity relation. In thick voxels the conservative scheme resolves where light is first scattered:
/// for lamps by first moments of their rays (Eq. (L13)), for an UncollidedImage by its mean directions and the
/// neighbouring voxels (Eq. (L14)), or at voxel centres if it has no mean directions.
///
/// In a distributed solve each rank holds its block and a halo of two layers; only the steady state can be solved, and
/// the result is that of one rank to the tolerance (numerics.md, section 10 c). Collective.
///
/// @param medium, ior, illumination  of the rank's block, with the grid domain.OwnGrid(); not read if that has no
///   voxels. ior: refractive index by voxel; null values: 1
/// @param settings  the same on all ranks
/// @return arrays of the block; energy balance, face powers and convergence of the domain
/// @throws InvalidInput on several ranks, if settings take steps (NotInBlocks) or differ between ranks; if voxels are
///   not cubes (to 0.1%), an index is not positive and finite (names the first such voxel), or the Check() of medium,
///   illumination or settings fails; if steps of the published scheme overflowed
/// @throws DeviceError if it does not fit the device
/// @throws Aborted
LightField SolveLatticeBoltzmann(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const Illumination& illumination, const LatticeSettings& settings, const Monitor& monitor = {});

/// Lattice-Boltzmann lighting with photons as uncollided light: photons march along bent rays to their first scattering
/// (PhotonMarcher), before the lattice solve or, depending on settings, interleaved with its steps
/// (InterleavedLattice.h). Of `illumination` only the diffuse light of sky and faces, and the faces' albedo, are used.
/// @param photons  photons of this rank; the list of all photons is that of rank 0, followed by that of rank 1, and so
///   on
/// @throws InvalidInput if an axis is periodic, under the conditions of PhotonMarcher, and as the function without
///   photons
LightField SolveLatticeBoltzmann(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const std::vector<Photon>& photons, const Illumination& illumination, const LatticeSettings& settings,
  const Monitor& monitor = {});
}
