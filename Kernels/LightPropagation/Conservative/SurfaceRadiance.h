#pragma once

#include "Distribution/Domain.h"
#include "LightPropagation/Diffusion/SurfacePowers.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// The radiance that leaves a medium of thick voxels through the faces of the box, W / (length^2 sr),
/// [cell][cosine][channel] (BoxFaces.h).
///
/// By cell, the sum of four terms of a half-space of isotropic scattering (numerics.md, Eq. (77); Chandrasekhar 1960):
/// what becomes of diffuse light from outside, of lamps' irradiance, of emission, and light from deep within, whose
/// amplitude is such that the power through the cell is that of the diffusion system, as far as that is known, Eq.
/// (79).
///
/// @param medium  scattering with g stands for isotropic scattering of sigma_s (1 - g)
/// @param faces  of the medium's grid that light leaves the box through; of the others it is 0
/// @param powers  by channel; without entries: the channel is dark
std::vector<float> SurfaceRadiance(const Medium& medium, const std::array<bool, 6>& faces,
  const std::vector<Light>& lamps, const std::vector<SurfacePowers>& powers);

/// The same of the domain's faces, known to all ranks; empty where no voxel at them is thick. Collective.
/// @param periodic  axes of the domain, which have no faces
/// @param medium  of this rank's block
/// @param powers  by channel and cell of the block's faces; empty without voxels
std::vector<float> SurfaceRadiance(const Domain& domain, const std::array<bool, 3>& periodic, const Medium& medium,
  int channels, const std::vector<Light>& lamps, const std::vector<SurfacePowers>& powers);

/// Whether a voxel at one of these faces is thicker across it than ThickAtSurface in any channel: only then is that
/// radiance known better than from the voxels' light.
bool IsThickAtFaces(const Medium& medium, const std::array<bool, 6>& faces, int channels);

/// Chandrasekhar's H(mu) for isotropic scattering, to 1% (B. Hapke, Icarus 157 (2002), equation 13; numerics.md,
/// Eq. (78)).
double HalfSpaceH(double albedo, double mu);
}
