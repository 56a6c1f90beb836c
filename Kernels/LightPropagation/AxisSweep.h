#pragma once

#include "RayPattern.h"

#include "../Device/Buffer.h"
#include "../Device/Monitor.h"

#include <functional>
#include <memory>

namespace tyndall
{
/// The widest vector of any kernel, floats.
constexpr std::size_t SweepPadding = 16;

/// The medium and the light on the device while a solver runs. Every array is [channel][stride] with voxels x fastest; the
/// stride is the voxel count rounded up to whole vectors, what is beyond the voxels is zero. Buffers
/// are SweepPadding floats longer: a vector that begins in them may be read whole.
struct SweepVolume
{
  Grid grid;
  int channels = 1;      ///< 1 or 3 that share one sigma_t
  std::size_t stride = 0;
  const Buffer<float>* sigma_t = nullptr; ///< 1/length
  std::size_t sigma_t_first = 0;          ///< where its channel begins
  const Buffer<float>* source = nullptr;  ///< W / (length^3 sr)
  const Buffer<float>* path = nullptr;    ///< W length, added to
  const Buffer<float>* flux = nullptr;    ///< W length, [channel][x, y, z][stride], added to; null: not wanted
  std::size_t first = 0; ///< where the first channel of source and path begins (flux: three times that)
};

/// Power that came in and went out in a sweep, W per channel and face -x, +x, -y, +y, -z, +z.
struct SweepTally
{
  std::array<Rgb, 6> in = {};
  std::array<Rgb, 6> out = {};
  Rgb onTheWay = {}; ///< left in the maps of a periodic axis
};

/// Carries all rays of a set of bundles through a volume along one axis, and deposits what they lose: propagate and collect
/// in one, without a buffer a direction (Gruson et al. need one, their section 4.1).
///
/// Memory: the maps, (plane's voxels) floats a direction and channel and way, and a few planes of scratch a unit.
class AxisSweep
{
public:
  /// Radiance, W / (length^2 sr), of `direction` (an index into the direction set; for beams irradiance and 0) that comes
  /// in through `face`.
  using Boundary = std::function<Rgb(int direction, int face)>;

  AxisSweep(Device& device, const Grid& grid, int axis, std::vector<Bundle> bundles, int channels,
    const std::array<bool, 3>& periodic);
  ~AxisSweep();

  /// Once through the volume, both ways.
  /// @param boundary  what comes in; empty: nothing
  /// @param hasSource  whether volume.source is to be read
  /// @param mostPlanes  that rays go on a periodic axis before they wait for the next Run
  /// @param monitor  told fractions of this sweep
  SweepTally Run(const SweepVolume& volume, const Boundary& boundary, bool hasSource, int mostPlanes,
    const Monitor& monitor);

  int DirectionCount() const; ///< rays families carried, both ways

private:
  struct Implementation;
  std::unique_ptr<Implementation> Inner;
};
}
