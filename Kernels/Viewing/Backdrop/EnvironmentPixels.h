#pragma once

#include "Device/OpenCL.h"
#include "Lights/Lights.h"

#include <vector>

namespace tyndall
{
/// An environment's pixels as rays look them up: with a column more on both sides, so that it closes.
struct EnvironmentPixels
{
  std::vector<cl_float4> shown; ///< what rays see that meet the medium; all of it, or what is not among the peaks
  std::vector<cl_float4> sharp; ///< the peaks, where they are apart
};

/// @param peaksApart  as where angular moments are shown (numerics.md, section 14.7)
EnvironmentPixels PixelsOf(const Environment& environment, bool peaksApart);
}
