#pragma once

#include "Device/Errors.h"
#include "IO/VDB/OpenVDB.h"
#include "Numerics/NumberText.h"

#include <cmath>
#include <string>

/// What numbers of 16 bits can hold.
namespace tyndall
{
/// Most that a number may change in 16 bits, relative to itself: twice what 11 significant bits round, so it is
/// exceeded only below 2^-14, where fewer bits are left.
constexpr double LargestHalfLoss = 1e-3;

/// Whether a real number survives 16 bits, as OpenVDB rounds it: not as infinity, nor with a loss. Infinity and NaN do.
template <typename Real>
bool FitsHalf(Real number)
{
  const double kept = openvdb::io::truncateRealToHalf(number), exact = number;
  return !std::isfinite(exact) || (std::isfinite(kept) && std::abs(kept - exact) <= LargestHalfLoss * std::abs(exact));
}

/// Does nothing for values whose type is not stored in 16 bits.
/// @param where  names the value, e.g. "in voxel (1, 2, 3)"
/// @throws InvalidInput with a half sentence about the array, where a number of the value does not fit
template <typename Value, typename Where>
void RequireHalf(const Value& value, const Where& where)
{
  if constexpr (openvdb::VecTraits<Value>::IsVec)
  {
    for (int component = 0; component < 3; ++component)
    {
      RequireHalf(value[component], where);
    }
  }
  else if constexpr (std::is_floating_point<Value>::value)
  {
    if (FitsHalf(value))
    {
      return;
    }
    throw InvalidInput("its value " + Text(sizeof(Value) > 4 ? "%.17g" : "%.9g", value) + " " + where() +
      (std::abs(value) > 1 ? " exceeds 65504, the largest number of 16 bits"
                           : " would lose more than 0.1% in 16 bits, which end at 6e-8") +
      ". Switch SaveAsHalf off");
  }
}
}
