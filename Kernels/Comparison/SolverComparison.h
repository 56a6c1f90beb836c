#pragma once

#include "Comparison/ComparedRun.h"
#include "Comparison/ConvergedLight.h"

#include <array>
#include <limits>
#include <string>
#include <vector>

/// Comparison of several solvers on one scene: error against run time.
namespace tyndall
{
/// Result of one method with one setting. NaN: unknown or not applicable.
struct ComparisonRow
{
  static constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

  ComparedMethod method = ComparedMethod::LightPropagationMaps;
  std::string setting;
  std::string filters; ///< ComparedRun::filters; empty: filters cannot repeat this row
  Grid grid;
  double seconds = Unknown; ///< smallest run time, from input arrays in memory to light in memory
  /// Smallest processor time of all threads of the process during a run, seconds; unknown on devices that are not CPUs.
  double coreSeconds = Unknown;
  double peakBytes = Unknown; ///< peak memory of buffers on the device, bytes
  /// Relative L2 error: 2-norm of the difference from the reference over voxels and channels, divided by the 2-norm of
  /// the reference.
  double errorL2 = Unknown;
  /// Largest difference from the reference in a voxel and channel, divided by the largest value of the reference.
  double errorMax = Unknown;
  /// Root mean square of the relative errors of the voxels in which the reference is above 0.
  double errorRelative = Unknown;
  double balance = Unknown; ///< relative error of the energy balance
  int iterations = 0;       ///< number of sweeps or scattering orders; 1 for photons
  /// The solver's own estimate of errorL2; unknown after one order (ErrorEstimate.h).
  double estimatedError = Unknown;
  /// Net escaped power through the faces -x, +x, -y, +y, -z, +z, summed over channels, W.
  std::array<double, 6> facePowerOut = {};
  double powerIn = 0.0; ///< entered and emitted power, summed over channels, W
  /// Whether no other row for the same quantity is faster and more accurate.
  bool pareto = false;
  bool recommended = false; ///< see MarkRecommended
};

/// Marks (`pareto`) the rows that no other row for the same quantity (QuantityOf) dominates. A row dominates another if
/// it is at least as fast and as accurate, and faster or more accurate. Rows without an error are not marked.
void MarkPareto(std::vector<ComparisonRow>& rows);

/// Marks one row per quantity as recommended: the fastest with an L2 error of at most `acceptedError` or, if there is
/// none, the most accurate. Only rows with an error that filters can repeat are considered. If a fluence is
/// recommended, pictures are made to show it: its filters are prepended to theirs.
void MarkRecommended(std::vector<ComparisonRow>& rows, double acceptedError);

/// The recommended row that a user wants most: that of pictures, otherwise of fluence, otherwise of uncollided fluence.
/// Null if no row is recommended.
const ComparisonRow* RecommendedOf(const std::vector<ComparisonRow>& rows);

struct RelativeErrors
{
  double l2 = 0.0, max = 0.0, relative = 0.0;
};
/// Errors of light as defined in ComparisonRow. Voxels in which the reference is NaN are skipped; errors are NaN if no
/// voxel is left or the reference is zero.
RelativeErrors ErrorsOf(const std::vector<float>& light, const std::vector<float>& reference);

struct ComparisonSettings
{
  std::vector<ComparedMethod> methods = { ComparedMethod::LightPropagationMaps, ComparedMethod::ConstantSource,
    ComparedMethod::Published, ComparedMethod::Photons };
  ComparedSettings tried;
  /// Timed runs per setting, after a run that compiles kernels. Settings that take less than 50 ms get 5 to 25 more
  /// runs, in turns. Fewer if the time budget does not allow them.
  int repeats = 3;
  /// Total time budget, seconds. Half of it is for the reference, unless the reference is given; the methods share the
  /// rest. A run that exceeds the budget is not started, or is stopped. Apart from that, the clock does not influence
  /// the comparison.
  double timeBudget = 300.0;
  double acceptedError = 0.01; ///< L2 error that the recommended setting may have
  bool estimates = true;       ///< whether solvers estimate their errors, in an extra run that is not timed
};

struct Comparison
{
  std::vector<ComparisonRow> rows;
  ReferenceLight reference;
  std::vector<std::string> leftOut;  ///< methods and settings that were not compared, with the reasons
  std::vector<std::string> warnings; ///< warnings about runs that the time budget did not allow
  std::string device;
};

/// Runs all methods with all settings, and compares their light with a reference.
/// @param reference  reference light; null: computed by ConvergedLight
/// @throws InvalidInput if the scene, the settings or the reference are invalid; DeviceError; Aborted
Comparison CompareSolvers(Device& device, const ComparedScene& scene, const ComparisonSettings& settings,
  const ReferenceLight* reference = nullptr, const Monitor& monitor = {});
}
