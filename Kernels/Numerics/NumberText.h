#pragma once

#include <cstdio>
#include <string>

namespace tyndall
{
/// A number in words for the user.
/// @param format  as of printf, for one double
inline std::string Text(const char* format, double value)
{
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}
}
