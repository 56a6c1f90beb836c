#pragma once

#include "Device/Errors.h"

#include <functional>

namespace tyndall
{
/// Progress callback. Every long computation calls it at least about ten times a second, with the fraction of the work
/// that is done, in [0, 1]. It returns false to abort the computation. Called on the thread that started the
/// computation.
using Monitor = std::function<bool(double fractionDone)>;

/// Monitor for a part of the work. Empty if `monitor` is.
/// @param monitor  monitor for all work, which must outlive the returned one
/// @param whole    maps the progress of the part to that of all work
template <class Whole>
Monitor OfPart(const Monitor& monitor, Whole whole)
{
  return monitor ? Monitor([&monitor, whole](double done) { return monitor(whole(done)); }) : Monitor();
}

/// Monitor for a part of the work that covers the range [from, to] of all progress. `monitor` must outlive it.
inline Monitor OfPart(const Monitor& monitor, double from, double to)
{
  return OfPart(monitor, [from, to](double done) { return from + (to - from) * done; });
}

/// Reports progress; an empty monitor never aborts.
/// @throws Aborted if the monitor returns false
inline void Report(const Monitor& monitor, double fractionDone)
{
  if (monitor && !monitor(fractionDone))
  {
    throw Aborted();
  }
}
}
