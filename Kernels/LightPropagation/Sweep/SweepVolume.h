#pragma once

#include "Device/Buffer.h"
#include "Lights/Lights.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <functional>

namespace tyndall
{
/// The channels from `first` on: those of a volume that begins there.
inline Rgb From(const Rgb& rgb, int first)
{
  return first == 0 ? rgb : Rgb{ rgb[first], 0.0, 0.0 };
}

/// The widest vector of any kernel, floats.
constexpr std::size_t SweepPadding = 16;

/// Optical length of voxels below which lamps' light is taken as lost evenly.
constexpr float ThinForMoments = 0.02f;

/// Where light is put down: everything is added to.
struct Deposit
{
  const Buffer<float>* path = nullptr; ///< W length, added to
  const Buffer<float>* flux = nullptr; ///< W length, [channel][x, y, z][stride], added to; null: not wanted
  /// W, [channel][-x, +x, -y, +y, -z, +z][stride], added to: power that enters each voxel through each of its faces
  /// (numerics.md, Eq. (29)); null: not wanted
  const Buffer<float>* partialCurrents = nullptr;
  /// First moments of the deposit, W length, [channel][-x, +x, -y, +y, -z, +z][stride], added to by lamps: the
  /// distance, in voxels from the middle towards each face (0 to 1/2), of the mean place where the light is lost that
  /// `path` stands for, times its path (numerics.md, Eq. (37)). 0 in voxels thinner than ThinForMoments. Null: not
  /// wanted.
  const Buffer<float>* moments = nullptr;
};

/// The medium and the light on the device while a solver runs. Every array is [channel][stride] with voxels x fastest;
/// the stride is the voxel count rounded up to whole vectors, what is beyond the voxels is zero. Buffers
/// are SweepPadding floats longer: a vector that begins in them may be read whole.
struct SweepVolume
{
  Grid grid;
  VoxelBox box;     ///< the part that is swept: rays start at its faces, where they would have come in; empty: all
  int channels = 1; ///< 1 or 3 that share one sigma_t
  std::size_t stride = 0;
  const Buffer<float>* sigma_t = nullptr; ///< 1/length
  std::size_t sigma_t_first = 0;          ///< where its channel begins
  const Buffer<float>* source = nullptr;  ///< W / (length^3 sr)
  Deposit deposit;
  /// Where the first channel of source and path begins (flux: three times that, partialCurrents and moments: six
  /// times).
  std::size_t first = 0;
};

/// Scratch that sweeps along different axes share: contents are undefined between sweeps.
struct SweepWorkspace
{
  Buffer<float> maps;    ///< the rays of an open axis
  Buffer<float> scratch; ///< planes being crossed
  Buffer<float> lost;    ///< what rounding takes from `path` in a sweep round a periodic axis

  /// Have room for so many floats. The device must be idle.
  void Reserve(Device& device, std::size_t mapFloats, std::size_t scratchFloats);
  void ReserveLost(Device& device, std::size_t floats);
};

/// Power that came in and went out in a sweep, W per channel and face -x, +x, -y, +y, -z, +z.
struct SweepTally
{
  std::array<Rgb, 6> in = {};
  std::array<Rgb, 6> out = {};
  Rgb onTheWay = {}; ///< left in the maps of a periodic axis
};

/// @param first  channel of the sum, that is the tally's first
inline void Add(SweepTally& sum, const SweepTally& tally, int first = 0)
{
  for (int c = 0; first + c < 3; ++c)
  {
    for (int face = 0; face < 6; ++face)
    {
      sum.in[face][first + c] += tally.in[face][c];
      sum.out[face][first + c] += tally.out[face][c];
    }
    sum.onTheWay[first + c] += tally.onTheWay[c];
  }
}

/// Radiance, W / (length^2 sr), of `direction` (an index into the direction set; for beams irradiance and 0) that comes
/// in through `face`.
using SweepBoundary = std::function<Rgb(int direction, int face)>;
}
