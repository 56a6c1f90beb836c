#pragma once

#include <vector>

namespace tyndall
{
/// Response of a uniform layer to light incident on one side: reflected and transmitted light, relative to that of a
/// layer in which each order's scattering source is uniform over the depth (numerics.md, Eqs. (46g), (46h)), from the
/// exact solution of the layer. Layout as in OctantSourcesShared.h, [albedo][depth][part].
struct VoxelResponse
{
  VoxelResponse();

  std::vector<float> diffuse; ///< alpha, beta for isotropic incident light
  /// The same for light that decays exponentially, for each rate; relative to the fraction of isotropic light that the
  /// layer removes.
  std::vector<float> falling;
};
}
