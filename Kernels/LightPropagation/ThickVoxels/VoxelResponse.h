#pragma once

#include <vector>

namespace tyndall
{
/// Response of a uniform layer to light incident on one side: the exact outgoing light of the layer, compared with that
/// of a layer in which each order's scattering source is uniform over the depth, as tables of the coefficients alpha
/// and beta of numerics.md, Eqs. (46g), (46h). Layout as in OctantSourcesShared.h, [albedo][depth][value].
struct VoxelResponse
{
  VoxelResponse();

  std::vector<float> diffuse; ///< coefficients for isotropic incident light
  /// Coefficients for first collisions whose density decays exponentially with depth, one table per rate of decay;
  /// relative to the fraction of isotropic light that the layer removes.
  std::vector<float> falling;
};
}
