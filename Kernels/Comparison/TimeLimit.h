#pragma once

#include "Device/Clock.h"
#include "Device/Monitor.h"

#include <algorithm>
#include <memory>

namespace tyndall
{
/// Thrown out of a computation that took longer than it was given.
struct TimeIsUp
{
};

/// Progress of the part [from, to] of the work; throws TimeIsUp after `seconds`.
inline Monitor PartWithin(double seconds, const Monitor& monitor, double from, double to)
{
  const double end = ClockSeconds() + seconds;
  return [=](double done) {
    if (ClockSeconds() > end)
    {
      throw TimeIsUp();
    }
    return !monitor || monitor(from + (to - from) * std::clamp(done, 0.0, 1.0));
  };
}
}
