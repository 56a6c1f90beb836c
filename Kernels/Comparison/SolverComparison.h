#pragma once

#include "Comparison/ComparedRun.h"
#include "Comparison/ComparisonRow.h"
#include "Comparison/ConvergedLight.h"

#include <string>
#include <vector>

/// Error against run time: solvers side by side on one scene.
namespace tyndall
{
struct ComparisonSettings
{
  std::vector<ComparedMethod> methods = { ComparedMethod::LightPropagationMaps, ComparedMethod::ConstantSource,
    ComparedMethod::Published, ComparedMethod::Photons };
  ComparedSettings tried;
  int repeats = 3; ///< runs that count, after any that compiles; fewer where the budget does not allow them
  /// Seconds for all: half of them for a reference that is not given, the others shared by the methods. A run that does
  /// not fit is not begun, or stopped. What is compared does not depend on the clock else.
  double timeBudget = 300.0;
  bool estimates = true; ///< let solvers estimate their errors, by a run whose time does not count
};

struct Comparison
{
  std::vector<ComparisonRow> rows;
  ReferenceLight reference;
  std::vector<std::string> leftOut;  ///< what was not compared, and why
  std::vector<std::string> warnings; ///< what the time did not allow
  std::string device;
};

/// Runs all methods at all settings.
/// @param reference  null: ConvergedLight
/// @throws InvalidInput for a scene, settings or a reference without meaning; DeviceError; Aborted
Comparison CompareSolvers(Device& device, const ComparedScene& scene, const ComparisonSettings& settings,
  const ReferenceLight* reference = nullptr, const Monitor& monitor = {});
}
