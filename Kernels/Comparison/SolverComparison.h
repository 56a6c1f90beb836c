#pragma once

#include "Comparison/ComparedRun.h"
#include "Comparison/ConvergedLight.h"

#include <array>
#include <limits>
#include <string>
#include <vector>

/// Error against run time of several solvers on one scene.
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

/// Sets `pareto` of each row that no other row for the same quantity dominates, i.e. is at least as fast and as
/// accurate, and better in one of both. Rows without an error are not marked.
void MarkPareto(std::vector<ComparisonRow>& rows);

struct RelativeErrors
{
  double l2 = 0.0, max = 0.0, relative = 0.0;
};
/// Errors as defined in ComparisonRow. Voxels in which the reference is NaN are skipped; the result is NaN if no voxel
/// is left or the reference is zero.
RelativeErrors ErrorsOf(const std::vector<float>& light, const std::vector<float>& reference);

struct ComparisonSettings
{
  std::vector<ComparedMethod> methods = { ComparedMethod::LightPropagationMaps, ComparedMethod::ConstantSource,
    ComparedMethod::Published, ComparedMethod::Photons };
  ComparedSettings tried;
  int repeats =
    3; ///< timed runs per setting, after a run that compiles kernels; fewer if the time budget does not allow them
  /// Total time budget, seconds: half for the reference, unless it is given; the methods share the rest. A run that
  /// does not fit is not started, or is stopped. Otherwise the clock does not influence what is compared.
  double timeBudget = 300.0;
  bool estimates = true; ///< let solvers estimate their errors, in an extra run that is not timed
};

struct Comparison
{
  std::vector<ComparisonRow> rows;
  ReferenceLight reference;
  std::vector<std::string> leftOut;  ///< settings that were not compared, and why
  std::vector<std::string> warnings; ///< what the time budget did not allow
  std::string device;
};

/// Runs all methods with all settings.
/// @param reference  reference light; null: computed by ConvergedLight
/// @throws InvalidInput if the scene, the settings or the reference are invalid; DeviceError; Aborted
Comparison CompareSolvers(Device& device, const ComparedScene& scene, const ComparisonSettings& settings,
  const ReferenceLight* reference = nullptr, const Monitor& monitor = {});
}
