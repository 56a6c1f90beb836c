#pragma once

#include "Device/Device.h"

#include <string>

namespace tyndall
{
/// The device's name for the user, and how much of a solve lay on it and how much in host memory, where any did.
/// @param ofSolve  the device with the solve's budget
std::string NameWithStreaming(const Device& ofSolve);
}
