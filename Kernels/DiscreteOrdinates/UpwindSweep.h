#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "DiscreteOrdinates/OrdinateGroups.h"
#include "Medium/Grid.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Incident radiance along a direction (an index) through a face -x, +x, -y, +y, -z, +z. W / (length^2 sr)
using IncomingRadiance = std::function<double(int direction, int face)>;

/// Power of one channel through the faces -x, +x, -y, +y, -z, +z, W.
struct FacePowers
{
  std::array<double, 6> in = {}, out = {};
  double onTheWay = 0.0; ///< left through a periodic face, wraps around in the next sweep
};

/// Transports light along all directions through the grid, once.
class OrdinateSweep
{
public:
  virtual ~OrdinateSweep() = default;

  /// @param radiance  on entry the source relative to `scale`, W / (length^3 sr); on return the mean radiance, W /
  ///   (length^2 sr)
  /// @param incoming  empty: no incident light except reflected light
  /// @return outgoing power before reflection, and incident power without reflection
  virtual FacePowers Apply(const Buffer<float>& radiance, const Buffer<float>& sigma_t, const Buffer<float>& scale,
    const IncomingRadiance& incoming, const Monitor& monitor) = 0;
};

/// One channel of light by cell of the box faces, as in FaceLight.
struct LightOfCells
{
  const Buffer<float>& out; ///< W; outgoing power is added
  const Buffer<float>& in;  ///< incident radiance
};

/// Boundary conditions of a sweep.
struct SweptFaces
{
  /// Periodic axes: light wraps around in the next sweep.
  std::array<bool, 3> periodic = {};
  /// Axes of one voxel in the whole grid: nothing varies along them, and no light is transported.
  std::array<bool, 3> unvarying = {};
  const LightOfCells* reflecting = nullptr; ///< null: no face reflects
  /// Bits of the faces -x, +x, ... +z that are interior to the whole grid: their power is not counted.
  int inner = 0;

  /// Boundary conditions of the whole grid. `reflecting` must outlive the result.
  static SweptFaces Of(const Grid& grid, const std::array<bool, 3>& periodic, const LightOfCells* reflecting);
};

/// Upwind sweep along all directions through a box of voxels (numerics.md, Eqs. (D9) to (D11)).
///
/// Each voxel is crossed along the mean chord of the direction, with exponential attenuation: stable and positive for
/// every optical thickness, and exact along an axis. Light that leaves a voxel enters the downwind voxels with equal
/// radiance, so power is conserved to rounding. The scheme is diffusive sideways: first order in the voxel edges for
/// oblique directions.
class UpwindSweep : public OrdinateSweep
{
public:
  UpwindSweep(Device& device, const Grid& grid, const OrdinateGroups& groups, const SweptFaces& faces);

  /// Bytes of device memory for the faces.
  static std::size_t Bytes(const Grid& grid, const OrdinateGroups& groups);

  FacePowers Apply(const Buffer<float>& radiance, const Buffer<float>& sigma_t, const Buffer<float>& scale,
    const IncomingRadiance& incoming, const Monitor& monitor) override;

  // The steps of Apply, for a pipeline over ranks: boundary source, some groups of directions, outgoing powers.
  void LetIn(const IncomingRadiance& incoming, FacePowers& powers);
  void SweepGroups(int first, int count, const Buffer<float>& radiance, const Buffer<float>& sigma_t,
    const Buffer<float>& scale, const Monitor& monitor);
  void Count(FacePowers& powers) const;
  void LeaveByCells() const; ///< does nothing if no face reflects

  /// Radiance through the faces perpendicular to an axis, [group][row][voxel of the row][8]: incident before the group
  /// is swept, outgoing afterwards. Perpendicular to z rows run along y, else along z.
  std::vector<float> ReadFace(int axis, int firstGroup, int groups) const;
  void WriteFace(int axis, int firstGroup, const std::vector<float>& values);

private:
  bool IsCarried(int axis) const { return !this->At.unvarying[axis]; }
  std::array<int, 2> FaceSize(int axis) const; ///< rows of a group, voxels of a row
  void LoadDirections();
  bool IsCounted(int face) const { return !(this->At.inner >> face & 1); }
  void FillFace(int axis, const IncomingRadiance& incoming, FacePowers& powers);
  void EnterByCells(int axis) const;
  cl::Kernel Kernel(const char* name, int width = 8) const;

  Device& TheDevice;
  Grid TheGrid;
  const OrdinateGroups& Groups;
  const SweptFaces At;
  Buffer<float> Shares, Across;
  Buffer<cl_int> Up;
  std::array<Buffer<float>, 3> Faces, Sums;
};
}
