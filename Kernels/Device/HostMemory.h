#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tyndall
{
/// Size of the machine's main memory, bytes.
std::size_t HostMemory();

/// Checks that arrays fit the machine's memory before they are allocated. Without this check, a machine that swaps
/// memory to disk would become slow without an error.
/// @param bytes  total size of the arrays
/// @param what  description of the arrays, e.g. "A medium of 4 x 4 x 4 voxels (28 bytes each)"
/// @param advice  a sentence that says what to do if they do not fit
/// @throws DeviceError if they exceed three quarters of the machine's memory
void RequireHostMemory(double bytes, const std::string& what, const std::string& advice);

/// size of a large memory page, bytes, where the system has pages larger than 4 kB
constexpr std::size_t LargePage = std::size_t(1) << 21;

/// Allocates the pages of a memory range now, on all cores and in pages of 2 MB if available. Page faults of a single
/// core, 4 kB each, can take longer than filling the memory. Contents are preserved. For memory that will be written
/// completely.
void TakePages(void* memory, std::size_t bytes);

/// An empty vector with capacity for `count` values, whose pages are allocated by TakePages.
template <class T = float>
std::vector<T> RoomFor(std::size_t count)
{
  std::vector<T> values;
  values.reserve(count);
  TakePages(values.data(), count * sizeof(T));
  return values;
}

/// A vector of `count` zeros, whose pages are allocated by TakePages.
template <class T = float>
std::vector<T> Zeros(std::size_t count)
{
  std::vector<T> values = RoomFor<T>(count);
  values.resize(count);
  return values;
}

/// A vector that MakeZeros fills with `count` zeros.
struct ZeroedArray
{
  std::vector<float>* values;
  std::size_t count;
};

/// Fills several arrays with zeros on all cores. On a single core this would take as long as the kernels that fill the
/// arrays later.
void MakeZeros(std::vector<ZeroedArray> arrays);
}
