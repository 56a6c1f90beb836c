#pragma once

#include <chrono>
#include <functional>

namespace tyndall
{
/// A monotonic clock: seconds since an arbitrary start. Work that is distributed by measured run times takes its clock
/// as a parameter, so that tests can control it.
using Clock = std::function<double()>;

/// The machine's clock.
inline double ClockSeconds()
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
}
