#include "Common/FiniteValues.h"

#include "Device/Errors.h"
#include "Medium/Medium.h"

#include "vtkImageData.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr const char* UsualAdvice =
  "Something is beyond what floats carry (3.4e+38): give lights, sky and emission less power (light is in proportion "
  "to it), "
  "the medium smaller coefficients, or choose a unit of length in which voxels are neither tiny nor huge.";

}

ArrayRanges RequireFinite(const char* array, const float* values, std::size_t count, int components,
  const std::function<std::string(std::size_t)>& place, const char* advice)
{
  ArrayRanges ranges = RangesOf(values, count, components);
  const std::size_t first = ranges.firstNotFinite;
  if (first == count)
  {
    return ranges;
  }
  const std::string where = place(first / static_cast<std::size_t>(components));
  const std::string value = std::isnan(values[first]) ? "not a number"
    : values[first] > 0.0f                            ? "infinite"
                                                      : "-infinite";
  throw InvalidInput("The output's '" + std::string(array) + "' would be " + value + " in " + where +
    " (the first such one), so there is no output. " + (advice ? advice : UsualAdvice));
}

ArrayRanges RequireFiniteCells(
  vtkImageData* image, const char* array, const float* values, std::size_t count, int components, const char* advice)
{
  Grid grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.size[axis] = std::max(image->GetDimensions()[axis] - 1, 1);
  }
  return RequireFinite(
    array, values, count, components, [&](std::size_t voxel) { return "voxel " + VoxelName(grid, voxel); }, advice);
}
}
