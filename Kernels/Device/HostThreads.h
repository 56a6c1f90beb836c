#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace tyndall
{
/// Parallel loop over a large array on all of the host's cores; a single core cannot use the full memory bandwidth.
///
/// Calls work(begin, end) concurrently for parts that together are [0, count), and waits for all of them. Results must
/// not depend on where a part begins, so that they are the same on any number of cores.
/// @param least  smallest number of elements per part; below some hundred kilobytes a thread costs more than it saves
/// @throws what a part threw, after all parts have ended; if several did, the error of the first of them
void InThreads(
  std::size_t count, std::size_t least, const std::function<void(std::size_t begin, std::size_t end)>& work);

/// The sum of term(begin, end) over pieces that together are [0, count). The terms are evaluated concurrently and added
/// in order, so that the sum is the same on any number of cores.
/// @param piece  elements per piece; the last may have fewer
double SumInThreads(
  std::size_t count, std::size_t piece, const std::function<double(std::size_t begin, std::size_t end)>& term);

/// Whether is(i) is true for any i in [0, count). Optimised for the case that none is; does not tell which.
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
