#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tyndall
{
/// Bytes of memory that the machine has.
std::size_t HostMemory();

/// Ask whether arrays fit before they are made: a machine that swaps does not say that they do not.
/// @param bytes   of all of them
/// @param what    they are, e.g. "A medium of 4 x 4 x 4 voxels (28 bytes each)"
/// @param advice  a sentence: what to do where they do not fit
/// @throws DeviceError where they exceed three quarters of the machine's memory
void RequireHostMemory(double bytes, const std::string& what, const std::string& advice);

/// `count` zeros, in pages of 2 MB where the system has them: to take a large array page by page of 4 kB can cost more
/// than to fill it.
std::vector<float> Zeros(std::size_t count);

/// An array that is to hold so many zeros.
struct ZeroedArray
{
  std::vector<float>* values;
  std::size_t count;
};

/// The same for several arrays at a time: a core alone takes as long for them as kernels do to fill them.
void MakeZeros(std::vector<ZeroedArray> arrays);
}
