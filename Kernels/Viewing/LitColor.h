#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/Medium.h"
#include "Viewing/ToneMapping.h"

#include <cstdint>
#include <vector>

namespace tyndall
{
/// A lit medium for programs that lay the screen's colours of voxels over each other, as volume mappers do, and know
/// nothing of light.
struct LitColor
{
  std::vector<std::uint8_t> rgba; ///< 4 per voxel; colours are not multiplied by alpha
  double distance = 1.0;          ///< alpha is the opacity across this, length
  double exposure = 1.0;          ///< what radiance was multiplied by
};

/// Colours of what each voxel sends to the eye, and its opacity (numerics.md, section 14.8).
///
/// Colour: the source function (sigma_s fluence / (4 pi) + emission) / sigma_t, tone mapped; where the medium is so
/// thin that it covers no ray, only as bright as it becomes. All light is scattered evenly, wherever the eye is.
/// A voxel without extinction has the mean colour of its neighbours: what is interpolated at the medium's rim is not
/// dark. Light that is emitted where nothing absorbs is not shown.
///
/// Alpha: 1 - exp(-k sigma_t distance), sigma_t the channels' mean. k makes up for colours being laid over each other
/// as the screen has them, where a thin veil looks darker than its radiance: a quarter of the most that a ray shows of
/// the voxel looks over black as ToneMap has it, Eq. (112d). In opaque media k is 1 in the dark, and 4.3 where exposed
/// radiance is 1.
///
/// Distance: the voxel's shortest edge, or more where the medium is so thin that 8 bits would not tell its parts.
///
/// @param fluence  1 or 3 components
/// @param tones  exposure 0 chooses it as AutomaticExposure does, of parallel views along the axes, from both sides
/// @throws InvalidInput for an exposure out of its range
LitColor ColorLitMedium(const Medium& medium, const Field& fluence, const ToneMapping& tones);

/// The same of a medium that is spread over ranks by blocks: each has the colours of its own voxels, with the exposure
/// and the distance of all. No rank has more than a layer of the others' voxels, depths of the whole grid's columns,
/// and the first one what columns show. All ranks call it.
/// @param medium, fluence  of the rank's block; not looked at without voxels
/// @param tones  the same on all
LitColor ColorLitMediumInBlocks(Communicator& communicator, const BlockPartition& partition, const Medium& medium,
  const Field& fluence, const ToneMapping& tones);
}
