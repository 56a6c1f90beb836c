#pragma once

#include <string>

namespace tyndall
{
/// A compiler option that defines a macro for a kernel.
inline std::string Define(const char* name, int value)
{
  return std::string(" -D") + name + "=" + std::to_string(value);
}
}
