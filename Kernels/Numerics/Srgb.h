#pragma once

#include <cmath>

namespace tyndall
{
/// Transfer function of sRGB displays (IEC 61966-2-1): display value of a linear one, both in [0, 1].
inline double EncodeSrgb(double linear)
{
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
}

/// Inverse of EncodeSrgb.
inline double DecodeSrgb(double encoded)
{
  return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}
}
