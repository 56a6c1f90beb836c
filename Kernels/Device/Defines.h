#pragma once

#include <string>
#include <vector>

namespace tyndall
{
/// A definition among the options that a kernel is compiled with.
inline std::string Define(const char* name, int value)
{
  return std::string(" -D") + name + "=" + std::to_string(value);
}
/// The same of several: what stands between the braces of an array.
inline std::string Define(const char* name, const std::vector<int>& values)
{
  std::string list;
  for (const int value : values)
  {
    list += (list.empty() ? "" : ",") + std::to_string(value);
  }
  return std::string(" -D") + name + "=" + list;
}
/// The same of a float, to six decimals.
inline std::string DefineFloat(const char* name, float value)
{
  return std::string(" -D") + name + "=" + std::to_string(value) + "f";
}
}
