#pragma once

#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"

namespace tyndall
{
/// Whether an estimated relative error (ConvergenceRow::residual) is as small as was asked for. Where a number of
/// orders was asked for, none is too large.
bool MeetsTolerance(const PropagationSettings& settings, double residual);

/// Sets `converged` of solved light, and adds to its `doubts` where it is not, or where power is left over.
void JudgeConvergence(const PropagationSettings& settings, LightField& light);
}
