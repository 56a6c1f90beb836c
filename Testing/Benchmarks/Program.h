#pragma once

#include "Arguments.h"

#include "Device/Device.h"

#include <functional>

namespace bench
{
/// The main of a benchmark that needs a device: finds it and runs `work`.
/// @return what main is to return: 125 where there is no device, failure if TYNDALL_REQUIRE_DEVICE is set or `work`
/// throws
int RunOnDevice(
  int argc, char* argv[], const std::function<void(tyndall::Device& device, const Arguments& arguments)>& work);
}
