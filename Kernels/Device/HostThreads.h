#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace tyndall
{
/// Parallel loop over a large array on all of the host's cores; a single core cannot use the full memory bandwidth.
///
/// Calls work(begin, end) concurrently for ranges that together are [0, count), and waits for all of them. The results
/// of `work` must not depend on where a range begins; they are then the same on any number of cores.
/// @param least  smallest number of elements per range; below some hundred kilobytes a thread costs more time than it
///   saves
/// @throws the error that `work` threw, after all ranges have ended; if it threw for several, the error of the first
///   range
void InThreads(
  std::size_t count, std::size_t least, const std::function<void(std::size_t begin, std::size_t end)>& work);

/// The sum of term(begin, end) over ranges that together are [0, count). Terms are evaluated concurrently and added in
/// order, so that the sum is the same on any number of cores.
/// @param piece  elements per range; the last range may have fewer
double SumInThreads(
  std::size_t count, std::size_t piece, const std::function<double(std::size_t begin, std::size_t end)>& term);

/// Whether is(i) is true for any i in [0, count). Fastest if it is true for none.
/// @param is  predicate without branches, so that it is vectorised
template <class Is>
bool AnyInThreads(std::size_t count, const Is& is)
{
  std::atomic<bool> any(false);
  InThreads(count, 1 << 18, [&](std::size_t begin, std::size_t end) {
    int here = 0;
    for (std::size_t i = begin; i < end; ++i)
    {
      here |= is(i) ? 1 : 0;
    }
    if (here != 0)
    {
      any = true;
    }
  });
  return any;
}
}
