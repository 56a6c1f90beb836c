#pragma once

#include "Device/Errors.h"

#include <functional>

namespace tyndall
{
/// Told the fraction done in [0, 1] at least about ten times a second by every long computation; returns false to stop
/// it. Called on the thread that started the computation.
using Monitor = std::function<bool(double fractionDone)>;

/// What a part of the work reports to: `whole` turns a fraction of it into that of all. Empty where `monitor` is, which
/// must stay.
template <class Whole>
Monitor OfPart(const Monitor& monitor, Whole whole)
{
  return monitor ? Monitor([&monitor, whole](double done) { return monitor(whole(done)); }) : Monitor();
}

/// The same of a part that goes from one fraction of all to another.
inline Monitor OfPart(const Monitor& monitor, double from, double to)
{
  return OfPart(monitor, [from, to](double done) { return from + (to - from) * done; });
}

/// Report progress and leave by Aborted where the caller wants to stop. An empty monitor never stops.
inline void Report(const Monitor& monitor, double fractionDone)
{
  if (monitor && !monitor(fractionDone))
  {
    throw Aborted();
  }
}
}
