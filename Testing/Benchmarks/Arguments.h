#pragma once

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
}
