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
/// Lattice-Boltzmann lighting (Geist et al. 2004; Bernabei et al., section III-C; numerics.md, section 10 c): the
/// photon density of each voxel along its links to neighbours collides and streams until it is steady. Uncollided light
/// is that of the illumination's image (UncollidedImage), or else that of lamps and environment by light propagation
/// maps; its first-collision source, emission, and diffuse light incident from sky and faces are diffused by the
/// lattice.
///
/// Conservative scheme: collisions are scaled so that densities are positive and power is conserved for any optical
/// thickness of a voxel; where it is above 4/3 mean free paths, links reflect a part. Light that crosses into a lower
/// refractive index is partly returned, according to total internal reflection, so that fluence / n^2 diffuses and a
/// furnace has fluence proportional to n^2; light of sky and faces is incident with its radiance times n^2. The steady
/// state is solved for directly (SteadyLattice.h), unless steps are asked for. Published scheme: the explicit
/// collisions of the paper, without refraction. Densities oscillate and grow where sigma_t h is above 1; a warning says
/// so.
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

/// The same with photons as uncollided light: they march along bent rays to their first scattering (PhotonMarcher),
/// either to their ends before the lattice solve or interleaved with its steps (InterleavedLattice.h), depending on
/// settings. From `illumination` only diffuse light and the faces' albedo are used, no lamps.
/// @param photons  this rank's share; all photons are those of rank 0, then those of rank 1, and so on
/// @throws InvalidInput if an axis is periodic, under PhotonMarcher's conditions, and as above
LightField SolveLatticeBoltzmann(Device& device, const Domain& domain, const Medium& medium, const Field& ior,
  const std::vector<Photon>& photons, const Illumination& illumination, const LatticeSettings& settings,
  const Monitor& monitor = {});
}
