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

constexpr std::size_t LargePage = std::size_t(1) << 21; ///< bytes, where the system has pages larger than 4 kB

/// Has the system give memory its pages now, on all cores and in pages of 2 MB where it has them: one core that meets
/// them one by one, of 4 kB each, can take longer for them than to fill them. What the memory holds stays. For memory
/// that will be written all over.
void TakePages(void* memory, std::size_t bytes);

/// No values yet, but room for `count`, in such pages.
template <class T = float>
std::vector<T> RoomFor(std::size_t count)
{
  std::vector<T> values;
  values.reserve(count);
  TakePages(values.data(), count * sizeof(T));
  return values;
}

/// `count` zeros, in such pages.
template <class T = float>
std::vector<T> Zeros(std::size_t count)
{
  std::vector<T> values = RoomFor<T>(count);
  values.resize(count);
  return values;
}

/// An array that is to hold so many zeros.
struct ZeroedArray
{
  std::vector<float>* values;
  std::size_t count;
};

/// The same for several arrays at a time: a core alone takes as long for them as kernels do to fill them.
void MakeZeros(std::vector<ZeroedArray> arrays);
}
