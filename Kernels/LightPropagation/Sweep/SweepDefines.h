#pragma once

#include "LightPropagation/Sweep/SweepPlan.h"

#include <string>

namespace tyndall
{
/// What the kernels of a plan are compiled for, as SweepLayout.cl asks for it, whatever a sweep wants of them besides.
std::string DefinesOf(const SweepPlan& plan);
}
