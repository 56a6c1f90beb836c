#pragma once

#include "Distribution/Domain.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"

#include <string>

namespace tyndall
{
/// Broadcasts the scalar results of a solve on one rank to all ranks: channels, numbers of directions, energy balance,
/// face powers, half-range flux, convergence, saved sweeps, device and leftOut. Arrays are not sent, nor are doubts,
/// since previews are not checked for errors. Collective.
/// @param found  true on the one rank that has the result
/// @param light  the result on that rank; receives it on the others
void ShareFigures(Communicator& communicator, bool found, LightField& light);

/// Sets `light.leftOut` on all ranks to that of the first rank that has voxels. Collective.
void ShareLeftOut(const Domain& domain, LightField& light);

/// Reason why a distributed solve cannot start from kept light, the same text on all ranks; empty if it can. Each rank
/// keeps the light of its block; if one rank cannot start from it, none does. Collective.
/// @param whyNot  the reason on this rank, from WhyNotBegun
std::string WhyNotBegunOnAny(Communicator& communicator, const KeptLight& kept, const std::string& whyNot);
}
