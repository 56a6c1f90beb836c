#pragma once

#include "LightPropagation/Emission/EmissionRaysShared.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include <vector>

namespace tyndall
{
/// Mirror symmetries of a medium with a localised emission: planes through the centres of the grid and of the emitting
/// box, across which extinction and emission are symmetric. The light has the same symmetry, so it is computed on the
/// low side of each plane and copied to the high side.
class EmissionMirrors
{
public:
  /// @param info  the grid and the emitting box
  /// @param emission  in the emitting box, W / (length^3 sr), [channel][voxel], x fastest
  EmissionMirrors(
    Device& device, const SweepVolume& volume, const EmissionInfo& info, const std::vector<float>& emission);

  /// Bit mask of the axes that are normal to a plane of symmetry.
  int Axes() const { return this->Mirrored; }
  /// Sets to 1 the entries of `voxels` and `cells` (index: FanFaceFirst) that are mirror images of others, so that
  /// their light is not computed.
  void MarkImages(const Buffer<float>& voxels, const Buffer<float>& cells) const;
  /// Copies the light of voxels to their mirror images.
  /// @param path  path integrals, [channel][voxel]
  /// @param flux  net flux, [channel][x, y, z][voxel]; empty if it is not computed
  void CopyVoxels(const Buffer<float>& path, const Buffer<float>& flux) const;
  /// Copies the light of face cells to their mirror images.
  /// @param faces  outgoing light, [cell][channel]
  void CopyCells(const Buffer<float>& faces) const;

private:
  void FindMirrored(const std::vector<float>& emission);

  Device& TheDevice;
  const SweepVolume& Volume;
  EmissionInfo Info;
  int Mirrored = 0;
};
}
