#pragma once

#include "LightPropagation/Sweep/SweepPlan.h"

#include <string>

namespace tyndall
{
/// Preprocessor definitions that SweepLayout.cl requires, for the kernels of `plan`. Options of a single sweep are
/// added by the caller.
std::string DefinesOf(const SweepPlan& plan);
}
