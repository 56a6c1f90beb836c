#pragma once

#include "Distribution/Domain.h"
#include "LightPropagation/Diffusion/DiffusionSystem.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Outgoing radiance of a medium of optically thick voxels through the faces of the box, W / (length^2 sr),
/// [cell][cosine][channel] (BoxFaces.h).
///
/// The radiance of a cell is the sum of four half-space solutions for isotropic scattering (numerics.md, Eq. (77);
/// Chandrasekhar 1960): reflected diffuse boundary light, reflected irradiance of lamps, emission, and light from deep
/// inside. The amplitude of the light from deep inside is such that the power through the cell is that of the diffusion
/// system, within the uncertainty of Eq. (79).
///
/// @param medium  with g other than 0, isotropic scattering of sigma_s (1 - g) is used
/// @param faces  which faces of the grid are faces of the box; the radiance of all other faces is 0
/// @param powers  power through the cells, by channel; a channel whose `net` is empty has no light
std::vector<float> SurfaceRadiance(const Medium& medium, const std::array<bool, 6>& faces,
  const std::vector<Light>& lamps, const std::vector<SurfacePowers>& powers);

/// Outgoing radiance through the faces of the whole domain, on all ranks; empty if no voxel at these faces is optically
/// thick. Collective.
/// @param periodic  periodic axes of the domain, which have no faces
/// @param medium  of this rank's block
/// @param powers  power through the cells of this rank's block, by channel; empty if it has no voxels
std::vector<float> SurfaceRadiance(const Domain& domain, const std::array<bool, 3>& periodic, const Medium& medium,
  int channels, const std::vector<Light>& lamps, const std::vector<SurfacePowers>& powers);

/// Chandrasekhar's function H(mu) for isotropic scattering, accurate to 1% (B. Hapke, Icarus 157 (2002), equation 13;
/// numerics.md, Eq. (78)).
double HalfSpaceH(double albedo, double mu);
}
