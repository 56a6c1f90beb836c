#pragma once

namespace tyndall
{
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
