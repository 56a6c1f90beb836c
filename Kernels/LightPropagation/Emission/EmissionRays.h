#pragma once

#include "LightPropagation/Emission/EmissionPeaks.h"
#include "LightPropagation/Emission/EmissionRaysShared.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include <vector>

#include "Device/Monitor.h"

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

/// Adds to a deposit the uncollided flux of a localised emission, which every voxel gathers along straight rays.
/// (Kobayashi et al. 2001, problem 1, shows the ray effects of a coarse quadrature for such an emission.)
///
/// Integrates the radiance over the solid angle of the peak's bounding box, and averages this integral over each voxel
/// (numerics.md, Eq. (40)), with exact optical lengths. Points in the voxel and directions form a rank-1 lattice in
/// five dimensions. Each voxel starts with 32 to 4096 rays, more for smaller grids and smaller errors. The number is
/// doubled, up to 4096, while the two halves of a voxel's rays differ by more than `error`. If the grid is so large
/// that every voxel would start with 32 rays, voxels far from the peak and cells of the box's faces share fans of rays
/// (EmissionFans.h).
///
/// Guarantees: the light has the symmetries of the scene, and absorbed, scattered and escaped power add up to the
/// emitted power.
///
/// Requires that no axis is periodic. Does not compute first moments of the deposit (Deposit::firstMoments): the light
/// removed in a voxel is taken as uniform over it.
///
/// @param firstChannel  channel of the peak that corresponds to the first channel of `volume`
/// @param error  accepted difference between the light of the first and the second half of a voxel's rays, relative to
///   the sum
/// @return tally with the escaped power; there is no incident power
SweepTally DepositEmission(Device& device, const SweepVolume& volume, int firstChannel, const EmissionPeak& peak,
  double error, const Monitor& monitor);
}
