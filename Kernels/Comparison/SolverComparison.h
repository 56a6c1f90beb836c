#pragma once

#include "Comparison/ComparedRun.h"
#include "Comparison/ComparisonRow.h"
#include "Comparison/ConvergedLight.h"

#include <string>
#include <vector>

/// Error against run time of several solvers on one scene.
namespace tyndall
{
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
