#pragma once

#include <cstddef>
#include <vector>

namespace tyndall
{
/// `count` distinct numbers in [0, size), ascending, one from each of `count` equal intervals. The place within an
/// interval follows the golden ratio: constant steps would be in phase with the powers of two that photons' starting
/// points are built from, and all chosen photons would start along one line.
std::vector<std::size_t> ChooseEvenly(std::size_t size, std::size_t count);
}
