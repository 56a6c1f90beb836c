#pragma once

#include "Distribution/Communicator.h"
#include "Light/LightField.h"

namespace tyndall
{
/// Broadcasts the scalar results of a solve on one rank to all ranks: channels, numbers of directions, energy balance,
/// face powers, half-range flux, convergence, saved sweeps, device and leftOut. Arrays are not sent, nor are doubts,
/// since a preview is not judged. Collective.
/// @param found  true on the one rank that has the result
void ShareFigures(Communicator& communicator, bool found, LightField& light);
}
