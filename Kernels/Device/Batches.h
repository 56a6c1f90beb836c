#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"

#include <algorithm>
#include <limits>

namespace tyndall
{
/// A long computation split into batches whose run times, by the device's clock, are so short that it reports progress
/// and can be aborted about ten times a second.
struct Batches
{
  std::size_t count = 0; ///< number of items (photons, pixels, voxels) that the computation processes
  std::size_t first = 1; ///< items in the first batch; its run time determines the size of the next batch
  std::size_t whole = 1; ///< each batch has a multiple of this number of items
  double seconds = 0.05; ///< target run time of a batch, seconds
  double growth = 4.0;   ///< largest ratio of the size of a batch to that of the one before
  std::size_t most = std::numeric_limits<std::size_t>::max(); ///< largest number of items in a batch
  double from = 0.0, to = 1.0; ///< progress that is reported at the start and at the end, in [0, 1]
};

/// Calls queue(begin, size), which queues work on the device, once per batch. Waits for the device and reports progress
/// after each batch.
/// @throws Aborted
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
