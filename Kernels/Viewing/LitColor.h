#pragma once

#include "Distribution/Domain.h"
#include "Medium/Medium.h"
#include "Viewing/ToneMapping.h"

#include <cstdint>
#include <vector>

namespace tyndall
{
/// Colours and opacities of a lit medium, for volume renderers that only blend the display colours of voxels and do not
/// compute light themselves.
struct LitColor
{
  std::vector<std::uint8_t> rgba; ///< red, green, blue, alpha per voxel; colours are not multiplied by alpha
  /// Path length that belongs to alpha: a path of this length through the voxel has the opacity alpha. Unit: length.
  double distance = 1.0;
  double exposure = 1.0; ///< factor by which radiance was multiplied before tone mapping
};

/// Computes the colour of the light that each voxel scatters and emits, and the voxel's opacity (numerics.md, section
/// 14.8).
///
/// Colour: the tone-mapped source function (sigma_s fluence / (4 pi) + emission) / sigma_t. Where the medium is too
/// thin to become opaque along any ray, the colour is reduced to the brightness that a ray can reach. Scattering is
/// taken as isotropic, so the colour does not depend on the position of the eye. A voxel without extinction receives
/// the mean colour of its neighbours, so that interpolation at the medium's rim does not darken it. Emission from
/// voxels without extinction is not shown.
///
/// Alpha: 1 - exp(-k sigma_t distance), with sigma_t averaged over the channels. Blending in display (gamma-encoded)
/// values makes a thin veil darker than its radiance. The factor k compensates for this: it makes a quarter of the
/// largest radiance that a ray receives from the voxel, blended over black, appear with the display value of ToneMap,
/// Eq. (112d). In opaque media k is 1 for dark voxels, and 4.3 where exposed radiance is 1.
///
/// Distance: the voxel's shortest edge, or more where the medium is so thin that 8 bits would not resolve its opacity.
///
/// On a domain that is decomposed into blocks, each rank computes the colours of its own voxels, with the exposure and
/// distance of the whole domain. A rank stores one layer of ghost cells and the optical depths of the whole grid's
/// columns; the first rank also stores the pixels of the views. Collective.
///
/// @param medium, fluence  medium and fluence of the rank's block; ignored if it has no voxels. fluence: 1 or 3
///   components, W / length^2
/// @param tones  the same on all ranks; exposure 0: chosen by AutomaticExposure from parallel views along the axes,
///   from both sides
/// @throws InvalidInput for an exposure out of its range
LitColor ColorLitMedium(const Domain& domain, const Medium& medium, const Field& fluence, const ToneMapping& tones);
}
