#pragma once

#include "LightPropagation/Conservative/TransportParts.h"

namespace tyndall
{
/// Corrects, after each sweep of scattered light, what leaves the box: the part of a voxel's light that escapes along
/// the finer directions of the boundary's light, less that along the usual ones (numerics.md, Eq. (46)). So light that
/// is the same everywhere stays so, though it comes in along the former and is swept along the latter.
class EscapeCorrection
{
public:
  /// @param parts  must stay; it has finer directions
  EscapeCorrection(TransportParts& parts, const Monitor& monitor);

  /// Subtracts from the path integrals of a sweep the light that would also have escaped along the finer directions.
  /// Only scattered light is corrected: emission may come from voxels too thin to subtract from.
  /// @return W, by channel
  Rgb Apply();

private:
  TransportParts& Parts;
  Buffer<float> Extra; ///< of a source of 1, W length
};
}
