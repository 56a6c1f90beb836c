#pragma once

#include <cstddef>

namespace tyndall
{
/// A number that is not negative, as sizes of arrays are counted.
constexpr std::size_t Count(int number)
{
  return static_cast<std::size_t>(number);
}

/// `value` rounded up to a multiple of `step`: of rows to whole vectors, of work to whole work-groups. Both positive.
template <class Integer>
constexpr Integer RoundUp(Integer value, Integer step)
{
  return (value + step - 1) / step * step;
}

/// Parts of `step` that `count` is cut into, the last one perhaps smaller.
template <class Integer>
constexpr Integer PartsOf(Integer count, Integer step)
{
  return (count + step - 1) / step;
}
}
