#pragma once

#include <chrono>

namespace tyndall
{
/// Seconds of a clock that never goes back.
inline double ClockSeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
}
