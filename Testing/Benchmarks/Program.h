#pragma once

#include "Device/Device.h"

#include <functional>
#include <string>
#include <vector>

namespace bench
{
/// What was asked for on the command line, but for --quick.
struct Arguments
{
  bool quick = false; ///< few seconds: --quick, or TYNDALL_BENCH_QUICK in the environment, as ctest sets it
  std::vector<std::string> words;

  /// Whether there are no words, or this is one of them.
  bool Asks(const std::string& word) const;
};

Arguments ReadArguments(int argc, char* argv[]);

/// The main of a benchmark that needs a device: finds it and runs `work`.
/// @return what main is to return: 125 where there is no device, failure if TYNDALL_REQUIRE_DEVICE is set or `work`
/// throws
int RunOnDevice(
  int argc, char* argv[], const std::function<void(tyndall::Device& device, const Arguments& arguments)>& work);
}
