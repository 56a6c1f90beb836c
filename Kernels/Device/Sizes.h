#pragma once

namespace tyndall
{
/// `value` rounded up to a multiple of `step`: of rows to whole vectors, of work to whole work-groups. Both positive.
template <class Integer>
constexpr Integer RoundUp(Integer value, Integer step)
{
  return (value + step - 1) / step * step;
}
}
