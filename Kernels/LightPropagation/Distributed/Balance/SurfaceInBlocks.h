#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LightPropagation/Diffusion/SurfacePowers.h"
#include "Lights/Lights.h"
#include "Medium/Medium.h"

#include <vector>

namespace tyndall
{
/// SurfaceRadiance.h of a grid that is spread over ranks: each finds that of its block's faces at the box's, and has
/// then those of all, which are as many as the box's faces have cells. All ranks call it.
/// @param medium  of the block; not looked at without voxels
/// @param channels  the same on all
/// @param powers  by channel and cell of the block's faces; empty without voxels
/// @return empty where on no rank a voxel at the box's faces is thick
std::vector<float> SurfaceRadianceInBlocks(Communicator& communicator, const BlockPartition& partition,
  const Medium& medium, int channels, const std::vector<Light>& lamps, const std::vector<SurfacePowers>& powers);
}
