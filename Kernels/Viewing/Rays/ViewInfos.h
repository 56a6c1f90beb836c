#pragma once

#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/GridBlock.h"
#include "Viewing/Scene/ViewSettings.h"
#include "Viewing/Scene/ViewShared.h"
#include "Viewing/Scene/ViewTraits.h"

namespace tyndall
{
/// Kernel parameters of the picture, its camera and the phase function; the caller sets background, environment and
/// bricks.
/// @param block  the medium's place in a larger grid; null: the medium is the whole domain
/// @throws InvalidInput for a degenerate camera or one too far away
ViewInfo ViewInfoOf(
  const Camera& camera, const ViewSettings& settings, const ViewTraits& traits, const GridBlock* block = nullptr);

/// Kernel parameters of surface, table and bent rays.
/// @param ofWhole  the block, if rays travel from block to block; else null
OpticsInfo OpticsInfoOf(const ViewSettings& settings, const ViewTraits& traits, const BlockOfScene* ofWhole = nullptr);
}
