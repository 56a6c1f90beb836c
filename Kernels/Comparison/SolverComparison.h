#pragma once

#include "Comparison/ComparedRun.h"

#include <limits>
#include <optional>
#include <string>
#include <vector>

/// Error against run time: solvers side by side on one scene.
namespace tyndall
{
/// The light that others are compared with.
struct ReferenceLight
{
  Grid grid; ///< the scene's, or one finer or coarser by whole factors: compared on the coarser of both
  int channels = 1;
  std::vector<float> fluence; ///< W / length^2, `channels` a voxel; empty: not known; NaN: not known in this voxel
  std::vector<float> fluenceDirect; ///< its unscattered part
  std::string text;                 ///< what it is
};

struct ComparisonSettings
{
  std::vector<ComparedMethod> methods = { ComparedMethod::LightPropagationMaps, ComparedMethod::ConstantSource,
    ComparedMethod::Published, ComparedMethod::Photons };
  ComparedSettings tried;
  int repeats = 3; ///< runs that count, after one that compiles; fewer where the budget does not allow them
  /// Seconds for all: half of them for a reference that is not given, the others shared by the methods. A run that does
  /// not fit is not begun, or stopped.
  double timeBudget = 300.0;
  bool estimates = true; ///< let solvers estimate their errors, by a run whose time does not count
};

/// NaN: not known, or there is no such thing.
struct ComparisonRow
{
  static constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();

  ComparedMethod method = ComparedMethod::LightPropagationMaps;
  std::string setting;
  Grid grid;
  double seconds = Unknown;   ///< median, from arrays in memory to light in memory
  double peakBytes = Unknown; ///< most bytes of buffers on the device
  double errorL2 =
    Unknown; ///< root of the sum over voxels and channels of squared differences, over that of the reference
  double errorMax = Unknown; ///< largest difference of a voxel's channel, over the largest of the reference
  double errorRelative =
    Unknown;                ///< root of the mean square of voxels' own relative errors, where the reference is above 0
  double balance = Unknown; ///< relative error of the energy balance
  int iterations = 0;       ///< sweeps or orders; 1 for photons
  double estimatedError = Unknown; ///< of errorL2 by the solver itself; not known after one order (ErrorEstimate.h)
  std::array<double, 6> facePowerOut = {}; ///< W, all channels, through -x, +x, -y, +y, -z, +z
  double powerIn = 0.0;                    ///< W, entered and emitted, all channels
  bool pareto = false;                     ///< no other row of the same quantity is faster and better
};

struct Comparison
{
  std::vector<ComparisonRow> rows;
  ReferenceLight reference;
  std::vector<std::string> leftOut; ///< what was not compared, and why
  std::string device;
};

/// Sets `pareto`: where no other row that is compared with the same quantity is both at least as fast and at least as
/// good, and one of both better. Rows without an error have none.
void MarkPareto(std::vector<ComparisonRow>& rows);

struct RelativeErrors
{
  double l2 = 0.0, max = 0.0, relative = 0.0;
};
/// See ComparisonRow. Voxels in which the reference is NaN do not count; NaN where there are none or the reference is
/// dark.
RelativeErrors ErrorsOf(const std::vector<float>& light, const std::vector<float>& reference);

/// A converged run of the best method: 256 directions a face, two rays a voxel's edge, tolerance 1e-6, on the doubled
/// grid; less of it where that would take more than `seconds`. Where light is bent, photons.
ReferenceLight ConvergedLight(Device& device, const ComparedScene& scene, const ComparedSettings& settings,
  double seconds, const Monitor& monitor = {});

/// Runs all methods at all settings.
/// @param reference  null: ConvergedLight
/// @throws InvalidInput for a scene, settings or a reference without meaning; DeviceError; Aborted
Comparison CompareSolvers(Device& device, const ComparedScene& scene, const ComparisonSettings& settings,
  const ReferenceLight* reference = nullptr, const Monitor& monitor = {});
}
