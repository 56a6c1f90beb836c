#pragma once

#include "Medium/Grid.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Light of pilot photons in coarse cells that fill the medium's box (Pfeuti 2009, section 3.2.2). Arrays have x
/// fastest.
struct PilotLight
{
  Grid grid; ///< the coarse cells; where they do not divide the voxels evenly, some have a voxel more than others
  int channels = 1;           ///< of fluence
  std::vector<float> fluence; ///< W / length^2, the mean over each cell's voxels
  std::vector<float> count;   ///< photons that crossed each cell, each once
  /// 2 per cell: mean column and row that its photons start from, 0 where there is none; their standard deviation.
  std::vector<float> originMean, originDeviation;
  double seconds = 0.0;
};
}
