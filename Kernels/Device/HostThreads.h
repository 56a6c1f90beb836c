#pragma once

#include <atomic>
#include <cstddef>
#include <functional>

namespace tyndall
{
/// Passes over large arrays on all of the host's cores: one core alone moves a part of what the memory can.
///
/// Calls work(begin, end), at the same time, for parts that together are [0, count), and waits for all of them. What a
/// part finds must not depend on where it begins, so that results are the same on any number of cores.
/// @param least  elements of a part, at least: below some hundred kilobytes a thread costs more than it saves
/// What a part throws is thrown when all have ended; of several the first part's.
void InThreads(
  std::size_t count, std::size_t least, const std::function<void(std::size_t begin, std::size_t end)>& work);

/// The sum of term(begin, end) over pieces that together are [0, count), found at the same time and added in turn: the
/// same on any number of cores.
/// @param piece  elements of a piece, but perhaps of the last
double SumInThreads(
  std::size_t count, std::size_t piece, const std::function<double(std::size_t begin, std::size_t end)>& term);

/// Whether is(i) for any i of [0, count): quick where none is, as a rule. To find which one takes another pass.
/// @param is  no branches, so that many are asked at a time
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
