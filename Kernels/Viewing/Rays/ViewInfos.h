#pragma once

#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/GridBlock.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewShared.h"
#include "Viewing/Scene/ViewTraits.h"

namespace tyndall
{
/// The picture and its camera, and the phase function, as kernels have them; background, environment and bricks are
/// left to who has them.
/// @param block  null: the medium is no block of a larger grid
/// @throws InvalidInput for a camera that looks nowhere or is too far away
ViewInfo ViewInfoOf(
  const Camera& camera, const ViewSettings& settings, const ViewTraits& traits, const GridBlock* block = nullptr);

/// Surface and table, and how rays bend.
/// @param ofWhole  where rays go from block to block: the block
OpticsInfo OpticsInfoOf(const ViewSettings& settings, const ViewTraits& traits, const BlockOfScene* ofWhole = nullptr);
}
