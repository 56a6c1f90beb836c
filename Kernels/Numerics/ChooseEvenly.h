#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Chooses `count` distinct numbers in [0, size), ascending, one from each of `count` equal intervals. The position
/// within an interval follows the golden ratio. Constant steps would not do: the starting points of photons depend on
/// the binary digits of their numbers, so that all chosen photons could start along one line.
inline std::vector<std::size_t> ChooseEvenly(std::size_t size, std::size_t count)
{
  std::vector<std::size_t> chosen;
  count = std::min(count, size);
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  for (std::size_t i = 0; i < count; ++i)
  {
    const double within = std::fmod((i + 1.0) * golden, 1.0);
    const auto number = static_cast<std::size_t>((i + within) / count * size);
    const std::size_t least = chosen.empty() ? 0 : chosen.back() + 1;
    chosen.push_back(std::clamp(number, least, size - (count - i)));
  }
  return chosen;
}
}
