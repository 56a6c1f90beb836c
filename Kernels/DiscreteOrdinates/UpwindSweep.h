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

/// Carries light once along all directions through the grid.
class OrdinateSweep
{
public:
  virtual ~OrdinateSweep() = default;

  /// @param radiance  source over `scale`, W / (length^3 sr); becomes the mean radiance, W / (length^2 sr)
  /// @param incoming  empty: none but reflected light
  /// @return outgoing power before reflection, and incident power without reflection
  virtual FacePowers Apply(const Buffer<float>& radiance, const Buffer<float>& sigma_t, const Buffer<float>& scale,
    const IncomingRadiance& incoming, const Monitor& monitor) = 0;
};

/// Light by cells of a box's faces, as FaceLight has it of one channel.
struct LightOfCells
{
  const Buffer<float>& out; ///< W that leave are added to
  const Buffer<float>& in;  ///< incident radiance
};

/// Boundary conditions of a box that is swept.
struct SweptFaces
{
  /// Periodic axes: light wraps around in the next sweep.
  std::array<bool, 3> periodic = {};
  /// Axes of one voxel in the whole grid: nothing varies along them, and no light is transported.
  std::array<bool, 3> unvarying = {};
  const LightOfCells* reflecting = nullptr; ///< null: no face gives back light
  /// Bits of the faces -x, +x, ... +z that are no faces of the whole grid: their power is not counted.
  int inner = 0;

  /// Of a box that is the whole grid. Must stay: `reflecting`.
  static SweptFaces Of(const Grid& grid, const std::array<bool, 3>& periodic, const LightOfCells* reflecting);
};

/// Carries light once along all directions through a box of voxels, upwind (numerics.md, Eqs. (D9) to (D11)).
///
/// Each voxel is crossed by the direction's mean chord, and light is attenuated along it by an exponential: it is
/// stable and positive for every optical thickness, and exact along an axis. Light that leaves a voxel enters the next
/// ones in equal radiance, so the power is kept to rounding; light spreads aside, so it is of first order in the
/// voxels' edges in oblique directions.
class UpwindSweep : public OrdinateSweep
{
public:
  UpwindSweep(Device& device, const Grid& grid, const OrdinateGroups& groups, const SweptFaces& faces);

  /// Bytes that the faces take on the device.
  static std::size_t Bytes(const Grid& grid, const OrdinateGroups& groups);

  FacePowers Apply(const Buffer<float>& radiance, const Buffer<float>& sigma_t, const Buffer<float>& scale,
    const IncomingRadiance& incoming, const Monitor& monitor) override;

  // The steps of Apply, for a pipeline over ranks: boundary source, some groups of directions, outgoing powers.
  void LetIn(const IncomingRadiance& incoming, FacePowers& powers);
  void SweepGroups(int first, int count, const Buffer<float>& radiance, const Buffer<float>& sigma_t,
    const Buffer<float>& scale, const Monitor& monitor);
  void Count(FacePowers& powers) const;
  void LeaveByCells() const; ///< nothing where no face reflects

  /// Radiance through the faces across an axis, [group][row][voxel of the row][8]: incident until the group is swept,
  /// outgoing after that. Across z rows are along y, else along z.
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
