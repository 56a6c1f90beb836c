#pragma once

#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Power of one channel through the cells of the box's faces, W / length^2, without light of lamps that was not
/// scattered.
struct SurfacePowers
{
  std::vector<double> net;       ///< out less in, by cell (BoxFaces.h)
  std::array<double, 6> in = {}; ///< through each face: what a cell's few rays bring of it differs from cell to cell
  const float* lamps = nullptr;  ///< fluence that came straight from lamps, by voxel
  double halfRange = 0.25; ///< of the directions that bring it: `in` of even light is its radiance times 4 pi of this
};

/// The radiance that leaves a medium of thick voxels through the faces of the box, W / (length^2 sr),
/// [cell][cosine][channel] (BoxFaces.h). Empty where no voxel at a face is thicker than ThickAtSurface.
///
/// The diffusion system knows how much power leaves through each cell; how that is spread over the angle is known of
/// half-spaces (Chandrasekhar 1960, Radiative Transfer, chapters III to V), isotropic scattering of albedo a, H its
/// function, c = sqrt(1 - a):
///   I(mu) = L (1 - c H(mu))                                             what diffuse light L from outside becomes
///         + sum over lamps of a E H(mu0) H(mu) / (4 pi (mu + mu0))      what their irradiance E of the face does
///         + B c H(mu), B = emission / sigma_a                           what the medium shines
///         + A H(mu) / (1 - k mu), k = sqrt(3) c                         what comes from deep within
/// and A is such that the power is right. In the first and the third part of it that is what diffusion with Marshak's
/// condition makes of them, (1 - 2 k / 3) / (1 + 2 k / 3) of L: what the system has found is compared with what it
/// would find in a half-space. A lamp's few rays bring more to one voxel than to the next: its part is compared by what
/// the voxel did lose of it. The difference is not known better than to c / 10 of what comes in, and
/// to half of what those rays bring too much or too little, so one as small as that is taken for none, and a larger one
/// as smaller by so much.
///
/// @param medium  scattering with g stands for isotropic scattering of sigma_s (1 - g)
/// @param powers  by channel; without entries: the channel is dark
std::vector<float> SurfaceRadiance(const Medium& medium, const std::array<bool, 3>& periodic,
  const std::vector<Light>& lamps, const std::vector<SurfacePowers>& powers);

/// Chandrasekhar's H(mu) for isotropic scattering, to 1% (B. Hapke, Icarus 157 (2002), equation 13).
double HalfSpaceH(double albedo, double mu);
}
