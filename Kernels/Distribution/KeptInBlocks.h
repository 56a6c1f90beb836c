#pragma once

#include "Distribution/Communicator.h"
#include "Light/KeptLight.h"

#include <string>

namespace tyndall
{
/// Of a grid that is spread over ranks by blocks, each of which keeps the light of its own: why they cannot begin from
/// it, the same clause on all. Where one cannot, none does. All ranks call it.
/// @param whyNot  of this rank, as WhyNotBegun has it
std::string WhyNotBegunOnAny(Communicator& communicator, const KeptLight& kept, const std::string& whyNot);
}
