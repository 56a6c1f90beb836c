#pragma once

#include "Comparison/ComparedRun.h"

#include <array>
#include <limits>
#include <string>

namespace tyndall
{
/// NaN: not known, or there is no such thing.
struct ComparisonRow
{
  static constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

  ComparedMethod method = ComparedMethod::LightPropagationMaps;
  std::string setting;
  Grid grid;
  double seconds = Unknown;   ///< median, from arrays in memory to light in memory
  double peakBytes = Unknown; ///< most bytes of buffers on the device
  /// Root of the sum over voxels and channels of squared differences, over that of the reference.
  double errorL2 = Unknown;
  double errorMax = Unknown; ///< largest difference of a voxel's channel, over the largest of the reference
  /// Root of the mean square of voxels' own relative errors, where the reference is above 0.
  double errorRelative = Unknown;
  double balance = Unknown;        ///< relative error of the energy balance
  int iterations = 0;              ///< sweeps or orders; 1 for photons
  double estimatedError = Unknown; ///< of errorL2 by the solver itself; not known after one order (ErrorEstimate.h)
  std::array<double, 6> facePowerOut = {}; ///< W, all channels, through -x, +x, -y, +y, -z, +z
  double powerIn = 0.0;                    ///< W, entered and emitted, all channels
  bool pareto = false;                     ///< no other row of the same quantity is faster and better
};
}
