#pragma once

#include "Distribution/Communicator.h"
#include "Light/KeptLight.h"

#include <string>

namespace tyndall
{
/// Why a distributed solve cannot start from kept light, the same clause on all ranks; empty if it can. Each rank keeps
/// the light of its block; if one cannot start from it, none does. Collective.
/// @param whyNot  the reason on this rank, from WhyNotBegun
std::string WhyNotBegunOnAny(Communicator& communicator, const KeptLight& kept, const std::string& whyNot);
}
