#pragma once

#include "LightPropagation/Emission/EmissionRaysShared.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include <vector>

namespace tyndall
{
/// Mirror symmetries of the scene: planes through the centres of the grid and of the emitting box across which
/// extinction and emission are symmetric. The light is then symmetric, too: it is computed on the low side and copied
/// to the high side.
class EmissionMirrors
{
public:
  /// @param info  the grid and the emitting box
  /// @param emission  of that box, [channel][voxel], x fastest
  EmissionMirrors(
    Device& device, const SweepVolume& volume, const EmissionInfo& info, const std::vector<float>& emission);

  /// Bit mask of the axes that have such a plane across them.
  int Axes() const { return this->Mirrored; }
  /// Sets the entries of mirror images to 1, of voxels and of cells of the faces (FanFaceFirst), so that they are not
  /// computed.
  void MarkImages(const Buffer<float>& voxels, const Buffer<float>& cells) const;
  /// @param path  [channel][stride]
  /// @param flux  [channel][x, y, z][stride], or empty
  void CopyVoxels(const Buffer<float>& path, const Buffer<float>& flux) const;
  /// @param faces  [cell][channel]
  void CopyCells(const Buffer<float>& faces) const;

private:
  void FindMirrored(const std::vector<float>& emission);

  Device& TheDevice;
  const SweepVolume& Volume;
  EmissionInfo Info;
  int Mirrored = 0;
};
}
