#pragma once

#include "Comparison/ComparedRun.h"

#include <array>
#include <limits>
#include <string>

namespace tyndall
{
/// Result of one method with one setting. NaN: unknown or not applicable.
struct ComparisonRow
{
  static constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

  ComparedMethod method = ComparedMethod::LightPropagationMaps;
  std::string setting;
  Grid grid;
  double seconds = Unknown;   ///< median, from arrays in memory to light in memory
  double peakBytes = Unknown; ///< peak memory of buffers on the device, bytes
  /// Relative L2 error: the 2-norm of the difference over voxels and channels, over that of the reference.
  double errorL2 = Unknown;
  double errorMax = Unknown; ///< largest difference in a voxel and channel, over the largest value of the reference
  /// Root mean square of the relative errors of voxels in which the reference is above 0.
  double errorRelative = Unknown;
  double balance = Unknown;        ///< relative error of the energy balance
  int iterations = 0;              ///< sweeps or orders; 1 for photons
  double estimatedError = Unknown; ///< the solver's own estimate of errorL2; unknown after one order (ErrorEstimate.h)
  std::array<double, 6> facePowerOut = {}; ///< net escaped power through -x, +x, -y, +y, -z, +z, all channels, W
  double powerIn = 0.0;                    ///< entered and emitted power, all channels, W
  bool pareto = false;                     ///< no other row for the same quantity is both faster and more accurate
};
}
