#pragma once

#include <string>

namespace tyndall
{
/// A definition among the options that a kernel is compiled with.
inline std::string Define(const char* name, int value)
{
  return std::string(" -D") + name + "=" + std::to_string(value);
}
/// The same of a float, to six decimals.
inline std::string DefineFloat(const char* name, float value)
{
  return std::string(" -D") + name + "=" + std::to_string(value) + "f";
}
}
