#pragma once

#include "LightPropagation/Emission/EmissionRaysShared.h"
#include "LightPropagation/Sweep/SweepVolume.h"

#include <vector>

namespace tyndall
{
/// Planes through the middle of the grid and of what shines, of which one side is the mirror image of the other:
/// extinction and emission are the same there, and so is the light. It is found on the low side alone and copied.
class EmissionMirrors
{
public:
  /// @param info  the grid and the box of what shines
  /// @param emission  of that box, [channel][voxel], x fastest
  EmissionMirrors(
    Device& device, const SweepVolume& volume, const EmissionInfo& info, const std::vector<float>& emission);

  /// Bits of the axes across which such planes lie.
  int Axes() const { return this->Mirrored; }
  /// Sets those to 1 that are images: of voxels, and of cells of the faces (FanFaceFirst).
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
