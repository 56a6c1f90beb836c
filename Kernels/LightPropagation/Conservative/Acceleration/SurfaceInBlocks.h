#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LightPropagation/Diffusion/SurfacePowers.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <array>
#include <vector>

namespace tyndall
{
/// SurfaceRadiance.h of a grid that is spread over ranks: each finds that of its block's faces at the box's, and has
/// then those of all, which are as many as the box's faces have cells. All ranks call it.
/// @param medium  of the block; not looked at without voxels
/// @param periodic  axes whose two ends touch: they have no faces
/// @param channels  the same on all
/// @param powers  by channel and cell of the block's faces; empty without voxels
/// @return empty where on no rank a voxel at the box's faces is thick
std::vector<float> SurfaceRadianceInBlocks(Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, const std::array<bool, 3>& periodic, int channels, const std::vector<Light>& lamps,
  const std::vector<SurfacePowers>& powers);
}
