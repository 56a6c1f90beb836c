#pragma once

#include <chrono>
#include <functional>

namespace tyndall
{
/// Tells seconds since some beginning, and never goes back. Work that is measured to be shared out takes its clock from
/// outside, so that tests can say how fast the machine is.
using Clock = std::function<double()>;

/// The machine's.
inline double ClockSeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
}
