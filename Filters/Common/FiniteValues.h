#pragma once

#include "Common/ArrayRanges.h"

#include <cstddef>
#include <functional>
#include <string>

class vtkImageData;

/// What leaves a filter is finite. Whoever packs an output's array asks here, once, before the array leaves: AddCells
/// does it for all cells. The look costs one pass over the memory, a thousandth of a solve, and finds ranges as well.
namespace tyndall
{
/// @param place   of a tuple, as a user finds it: "voxel (1, 2, 3)", "photon 5"
/// @param advice  what to do; null: what holds for light and coefficients of a medium
/// @return ranges, to be left in the array
/// @throws InvalidInput where a value is not finite: names the array, the first such place, the value, the likely cause
ArrayRanges RequireFinite(const char* array, const float* values, std::size_t count, int components,
  const std::function<std::string(std::size_t)>& place, const char* advice = nullptr);

/// The same of the cells of an image.
ArrayRanges RequireFiniteCells(vtkImageData* image, const char* array, const float* values, std::size_t count,
  int components, const char* advice = nullptr);
}
