#pragma once

#include <array>
#include <cstddef>
#include <vector>

class vtkDataArray;

/// Smallest and largest values of arrays, found in threads where the values are made, and left where VTK and ParaView
/// look for them before they compute: in the array's vtkInformation. ParaView asks for the range of every component
/// and of the norm of tuples, of every array that a filter gives out; VTK finds each in a pass of its own on one core.
namespace tyndall
{
struct ArrayRanges
{
  std::vector<std::array<double, 2>> components; ///< empty: there are no values
  std::array<double, 2> norm = {};               ///< of the tuples' Euclidean norm; as vtkDataArray finds it, in double
  std::size_t firstNotFinite = 0; ///< number of the first value that is infinite or NaN; else their count
};

/// @param count  of values, all components of all tuples
/// Where a value is not finite nothing but its number is right.
ArrayRanges RangesOf(const float* values, std::size_t count, int components);

/// Leave ranges of finite values in an array that nobody writes to any more: Modified() drops them, as it does VTK's
/// own. Names and the number of components come before.
void LeaveRanges(const ArrayRanges& ranges, vtkDataArray* array);

/// The same of an array that has the values of another one, as far as ranges were left in that.
void LeaveSameRanges(vtkDataArray* from, vtkDataArray* array);

/// The same, found here; nothing where a value is not finite, or for arrays other than of float, double, int and
/// unsigned char in tuples.
void LeaveRanges(vtkDataArray* array);
}
