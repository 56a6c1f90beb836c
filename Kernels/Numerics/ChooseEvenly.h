#pragma once

#include <cstddef>
#include <vector>

namespace tyndall
{
/// `count` different numbers from 0 to size - 1, ascending, one from each of `count` equal stretches. Its place in the
/// stretch follows the golden ratio: with equal steps, which are in phase with the powers of two that photons' starting
/// places are made of, all chosen photons would start along one line.
std::vector<std::size_t> ChooseEvenly(std::size_t size, std::size_t count);
}
