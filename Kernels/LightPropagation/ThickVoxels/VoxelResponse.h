#pragma once

#include <vector>

namespace tyndall
{
/// How a uniform layer sends back light that comes in at one side, over what it does where all that it scatters in one
/// order shines evenly from its whole depth (numerics.md, Eqs. (46g), (46h)): from the exact solution of the layer.
/// Laid out as OctantSourcesShared.h says, [albedo][depth][part].
struct VoxelResponse
{
  VoxelResponse();

  std::vector<float> diffuse; ///< alpha, beta of light that comes in evenly from all directions
  /// The same of light that falls off exponentially, for each fall, over what of even light is lost in the layer.
  std::vector<float> falling;
};
}
