#pragma once

#include <cstddef>

namespace tyndall
{
/// Converts a non-negative number to std::size_t.
constexpr std::size_t Count(int number)
{
  return static_cast<std::size_t>(number);
}

/// `value` rounded up to a multiple of `step`, both positive; for example, rows to complete vectors, or ranges to
/// complete work-groups.
template <class Integer>
constexpr Integer RoundUp(Integer value, Integer step)
{
  return (value + step - 1) / step * step;
}

/// Number of parts of `step` elements into which `count` elements are divided; the last part may be smaller.
template <class Integer>
constexpr Integer PartsOf(Integer count, Integer step)
{
  return (count + step - 1) / step;
}
}
