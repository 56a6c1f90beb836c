#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"

#include <algorithm>
#include <limits>

namespace tyndall
{
/// A long computation in parts, so that it can report and be stopped about ten times a second by the device's clock.
struct Batches
{
  std::size_t count = 0; ///< of what is to be computed
  std::size_t first = 1; ///< of it in the first part; how long that takes says how large the next ones are
  std::size_t whole = 1; ///< parts are multiples of this
  double seconds = 0.05; ///< that a part is to take
  double growth = 4.0;   ///< of a part over the last one, at most
  std::size_t most = std::numeric_limits<std::size_t>::max(); ///< in a part, however soon the last one was done
  double from = 0.0, to = 1.0;                                ///< fractions done that are reported
};

/// Queues each part, queue(begin, size), waits for it and reports. @throws Aborted
template <class Queue>
void InBatches(Device& device, const Batches& batches, const Monitor& monitor, const Queue& queue)
{
  const auto rounded = [&](double size) {
    const double within = std::min(size, static_cast<double>(batches.most));
    const std::size_t parts = static_cast<std::size_t>(within / batches.whole);
    return std::max<std::size_t>(parts, 1) * batches.whole;
  };
  std::size_t batch = rounded(static_cast<double>(batches.first));
  for (std::size_t begin = 0; begin < batches.count;)
  {
    const std::size_t size = std::min(batch, batches.count - begin);
    const double start = device.Now();
    queue(begin, size);
    device.Finish();
    begin += size;
    Report(monitor, batches.from + (batches.to - batches.from) * begin / batches.count);
    const double took = device.Now() - start;
    batch = rounded(size * std::min(batches.seconds / std::max(took, 1e-6), batches.growth));
  }
}
}
