#pragma once

#include "Distribution/Communicator.h"
#include "Light/LightField.h"

namespace tyndall
{
/// What is told of light that one rank found, to all: channels, numbers of directions, balance, powers through faces,
/// half-range flux, convergence, sweeps saved, device and what was left out. No arrays, and no doubts: a preview is not
/// judged. All ranks call it.
/// @param found  on the one rank that has it
void ShareFigures(Communicator& communicator, bool found, LightField& light);
}
