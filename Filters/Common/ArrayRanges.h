#pragma once

#include <array>
#include <cstddef>
#include <vector>

class vtkDataArray;

/// Ranges (smallest and largest value) of arrays, computed in parallel when the values are produced and stored in the
/// array's vtkInformation, where VTK and ParaView look for a range before they compute it. ParaView requests the range
/// of every component and of the tuples' norm of every output array; VTK computes each of them in a separate pass on
/// one core.
namespace tyndall
{
struct ArrayRanges
{
  std::vector<std::array<double, 2>> components; ///< range of each component; empty: there are no values
  std::array<double, 2> norm = {};               ///< range of the tuples' Euclidean norm, in double as in vtkDataArray
  /// Index of the first value that is infinite or NaN; the number of values if all are finite.
  std::size_t firstNotFinite = 0;
};

/// Computes the ranges. If a value is not finite, only firstNotFinite is valid.
/// @param count  number of values: components times tuples
ArrayRanges RangesOf(const float* values, std::size_t count, int components);

/// Stores ranges in an array whose values are all finite and final: Modified() removes them, as it does VTK's own
/// ranges. Set the array's name and number of components before.
void LeaveRanges(const ArrayRanges& ranges, vtkDataArray* array);

/// Copies the ranges that are stored in `from` to an array with the same values, as far as there are any.
void LeaveSameRanges(vtkDataArray* from, vtkDataArray* array);

/// Computes and stores the ranges of an array. Does nothing if a value is not finite, or unless the array is an array
/// of structures (AOS) of float, double, int or unsigned char.
void LeaveRanges(vtkDataArray* array);
}
