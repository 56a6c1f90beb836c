#pragma once

#include "Light/LightField.h"
#include "LightPropagation/PropagationSettings.h"

namespace tyndall
{
/// Whether an estimated relative error (ConvergenceRow::residual) is as small as was asked for; not where a number of
/// orders was asked for instead.
bool MeetsTolerance(const PropagationSettings& settings, double residual);

/// Of a solve, [0, 1]: orders of those asked for, else how far the logarithm of the residual has come, and a little
/// more with each iteration.
/// @param residual  of the last iteration, 1 before there is one
/// @param iterations  done, with the part of the one under way
double ProgressOf(const PropagationSettings& settings, double residual, double iterations);

/// Part of the first iteration's progress that uncollided light takes.
constexpr double UncollidedPart = 0.5;

/// Sets `converged` of solved light, and adds to its `doubts` where it is not, or where power is left over.
void JudgeConvergence(const PropagationSettings& settings, LightField& light);
}
