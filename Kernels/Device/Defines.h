#pragma once

#include <string>

namespace tyndall
{
/// A definition among the options that a kernel is compiled with.
inline std::string Define(const char* name, int value)
{
  return std::string(" -D") + name + "=" + std::to_string(value);
}
}
