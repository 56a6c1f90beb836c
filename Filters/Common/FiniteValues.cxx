#include "Common/FiniteValues.h"

#include "Device/Errors.h"
#include "Medium/Medium.h"

#include "vtkImageData.h"
#include "vtkSMPTools.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace tyndall
{
namespace
{
constexpr std::size_t BlockSize = 16384; ///< values looked at before the next question whether any was found

constexpr const char* UsualAdvice =
  "Something is beyond what floats carry (3.4e+38): give lights, sky and emission less power (light is in proportion "
  "to it), "
  "the medium smaller coefficients, or choose a unit of length in which voxels are neither tiny nor huge.";

/// Whether any exponent is all ones, which that of infinity and of NaN is. A loop that compilers vectorise.
bool HasNotFinite(const float* values, std::size_t count)
{
  constexpr std::uint32_t Exponent = 0x7f800000u;
  std::uint32_t any = 0;
  for (std::size_t i = 0; i < count; ++i)
  {
    std::uint32_t bits;
    std::memcpy(&bits, values + i, sizeof(bits));
    any |= (bits & Exponent) == Exponent ? 1u : 0u;
  }
  return any != 0;
}
}

std::size_t FirstNotFinite(const float* values, std::size_t count)
{
  const std::size_t blocks = (count + BlockSize - 1) / BlockSize;
  std::atomic<std::size_t> first(blocks);
  vtkSMPTools::For(0, static_cast<vtkIdType>(blocks), [&](vtkIdType begin, vtkIdType end) {
    for (auto block = static_cast<std::size_t>(begin); block < static_cast<std::size_t>(end) && block < first; ++block)
    {
      const std::size_t from = block * BlockSize;
      std::size_t known = first;
      while (block < known && HasNotFinite(values + from, std::min(BlockSize, count - from)) &&
        !first.compare_exchange_weak(known, block))
      {
      }
    }
  });
  const float* const from = values + std::min(first * BlockSize, count);
  return static_cast<std::size_t>(
    std::find_if(from, values + count, [](float value) { return !std::isfinite(value); }) - values);
}

void RequireFinite(const char* array, const float* values, std::size_t count, int components,
  const std::function<std::string(std::size_t)>& place, const char* advice)
{
  const std::size_t first = FirstNotFinite(values, count);
  if (first == count)
  {
    return;
  }
  const std::string where = place(first / static_cast<std::size_t>(components));
  const std::string value = std::isnan(values[first]) ? "not a number"
    : values[first] > 0.0f                            ? "infinite"
                                                      : "-infinite";
  throw InvalidInput("The output's '" + std::string(array) + "' would be " + value + " in " + where +
    " (the first such one), so there is no output. " + (advice ? advice : UsualAdvice));
}

void RequireFiniteCells(
  vtkImageData* image, const char* array, const float* values, std::size_t count, int components, const char* advice)
{
  Grid grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.size[axis] = std::max(image->GetDimensions()[axis] - 1, 1);
  }
  RequireFinite(
    array, values, count, components, [&](std::size_t voxel) { return "voxel " + VoxelName(grid, voxel); }, advice);
}
}
