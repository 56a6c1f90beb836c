#pragma once

#include "Device/Device.h"

#include <string>

namespace tyndall
{
/// The device's name for the user, followed, if a solve used host memory, by how much lay on the device and how much in
/// host memory.
/// @param ofSolve  the device with the solve's budget
std::string NameWithStreaming(const Device& ofSolve);
}
