#pragma once

#include "LightPropagation/Conservative/MediumOnDevice.h"
#include "LightPropagation/Conservative/TransportParts.h"

#include <vector>

namespace tyndall
{
/// More, or less, of what sets out from a voxel gets out of the box along finer directions than along the usual ones.
/// Where light from outside comes in along the finer ones and scattered light is swept along the usual, this puts it
/// right after each sweep, so that light that is the same everywhere stays so whatever comes in.
class EscapeCorrection
{
public:
  /// @param parts  must stay; it has finer directions
  EscapeCorrection(TransportParts& parts, const Monitor& monitor);

  /// Takes from the path integrals of a sweep what escaped besides of the scattered light that was its source. What the
  /// medium shines itself is left to the sweep: it may come from voxels so thin that they have nothing to give.
  /// @return W, by channel
  Rgb Apply();

private:
  TransportParts& Parts;
  Buffer<float> Extra; ///< of a source of 1, W length
};
}
