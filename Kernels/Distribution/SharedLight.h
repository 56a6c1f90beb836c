#pragma once

#include "Distribution/Communicator.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"

#include <string>

namespace tyndall
{
/// Broadcasts the scalar results of a solve on one rank to all ranks: channels, numbers of directions, energy balance,
/// face powers, half-range flux, convergence, saved sweeps, device and leftOut. Arrays are not sent, nor are doubts,
/// since a preview is not judged. Collective.
/// @param found  true on the one rank that has the result
void ShareFigures(Communicator& communicator, bool found, LightField& light);

/// Why a distributed solve cannot start from kept light, the same clause on all ranks; empty if it can. Each rank keeps
/// the light of its block; if one cannot start from it, none does. Collective.
/// @param whyNot  the reason on this rank, from WhyNotBegun
std::string WhyNotBegunOnAny(Communicator& communicator, const KeptLight& kept, const std::string& whyNot);
}
