#pragma once

#include "Device/Errors.h"

#include <functional>

namespace tyndall
{
/// Progress callback: every long computation calls it at least about ten times a second with the fraction done, in [0,
/// 1]; it returns false to abort. Called on the thread that started the computation.
using Monitor = std::function<bool(double fractionDone)>;

/// Monitor for a part of the work: `whole` maps the part's progress to that of all work. Empty if `monitor` is, which
/// must outlive it.
template <class Whole>
Monitor OfPart(const Monitor& monitor, Whole whole)
{
  return monitor ? Monitor([&monitor, whole](double done) { return monitor(whole(done)); }) : Monitor();
}

/// The same for a part that covers the range [from, to] of all work.
inline Monitor OfPart(const Monitor& monitor, double from, double to)
{
  return OfPart(monitor, [from, to](double done) { return from + (to - from) * done; });
}

/// Reports progress; throws Aborted if the monitor returns false. An empty monitor never aborts.
inline void Report(const Monitor& monitor, double fractionDone)
{
  if (monitor && !monitor(fractionDone))
  {
    throw Aborted();
  }
}
}
