#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "DiscreteOrdinates/OrdinateGroups.h"
#include "DiscreteOrdinates/OrdinatesShared.h"
#include "Medium/BoxFaces.h"
#include "Medium/Grid.h"
#include "Medium/VoxelBox.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Incident radiance, W / (length^2 sr), along a direction (an index) through a face -x, +x, -y, +y, -z, +z.
using IncomingRadiance = std::function<double(int direction, int face)>;

/// Power of one channel through the faces -x, +x, -y, +y, -z, +z, W.
struct FacePowers
{
  std::array<double, 6> in = {}, out = {};
  double onTheWay = 0.0; ///< power that left through periodic faces and wraps around in the next sweep
};

/// Sums over directions that a sweep computes.
struct SweptSums
{
  /// Sums over the directions of each group, [group][voxel][4], groups OrdinateStride() voxels apart: power through
  /// faces of a voxel normal to x, y and z, W; fluence, W / length^2.
  const Buffer<float>& values;
  const Buffer<float>* even; ///< isotropic source, W / (length^3 sr); null: the source is OrdinateArrays::radiance
  std::size_t firstExtinction, first; ///< index of the channel's first value in OrdinateArrays::sigma_t, and in `even`
  bool byDiamonds;                    ///< whether the sweep is by weighted diamond differences; false: by mean chords
  bool ofMean; ///< whether the powers are those of the voxel's mean radiance; false: of the light that enters it
};

/// Arrays over the voxels of a sweep.
struct OrdinateArrays
{
  /// On entry the source, W / (length^3 sr), to be multiplied by `scale`; on return the mean radiance of each voxel,
  /// W / (length^2 sr). Not used if sums.even is given.
  const Buffer<float>& radiance;
  const Buffer<float>& sigma_t;    ///< extinction, 1/length
  const Buffer<float>& scale;      ///< factor of the source, by voxel; not used with sums
  const SweptSums* sums = nullptr; ///< null: no sums
  /// Whether only light that wraps around periodic axes is incident, and no reflected light.
  bool onlyWraps = false;
  /// Whether each block of OrdinateBlock consecutive voxels has neither medium nor source: its source is then not read,
  /// and `radiance` receives only sums over directions, for AngularScattering. Null: no such block
  const Buffer<cl_uchar>* empty = nullptr;
  bool netFlux = false; ///< whether these sums include the net flux
};

/// Sweep of discrete ordinates: transports light along all directions through the grid once.
class OrdinateSweep
{
public:
  virtual ~OrdinateSweep() = default;

  /// @param incoming  boundary source; empty: no light is incident except reflected light
  /// @param shines  whether any source may be non-zero; if not, a sweep may omit directions without incident light
  /// @return outgoing power before reflection, and incident power of the boundary source
  virtual FacePowers Apply(
    const OrdinateArrays& arrays, const IncomingRadiance& incoming, bool shines, const Monitor& monitor) = 0;
  /// Discards the light that wraps around periodic axes in the next sweep.
  virtual void Forget() = 0;
};

/// Light of one channel in each cell of the box's faces: the arrays FaceLight::Out() and In().
struct LightOfCells
{
  const Buffer<float>& out; ///< outgoing power of each cell, W; sweeps add to it
  const Buffer<float>& in;  ///< reflected radiance of each cell, W / (length^2 sr), incident in the next sweep
  std::size_t first = 0;    ///< index of the channel's first cell in both arrays
};

/// Boundary conditions of a sweep.
struct SweptFaces
{
  /// Periodic axes, around which light wraps in the next sweep.
  std::array<bool, 3> periodic = {};
  /// Axes along which the whole grid has one voxel and is periodic: nothing varies along them, and no light is
  /// transported along them.
  std::array<bool, 3> unvarying = {};
  /// outgoing and reflected light by cell of the box's faces; null: no face reflects
  const LightOfCells* reflecting = nullptr;
  /// Bit mask of the faces -x, +x, ... +z of the block that are interior to the whole grid; their power is not counted.
  int inner = 0;

  /// Boundary conditions of the whole grid. `reflecting` must outlive the result.
  static SweptFaces Of(const Grid& grid, const std::array<bool, 3>& periodic, const LightOfCells* reflecting);
};

/// Upwind sweep along all directions through a box of voxels (numerics.md, Eqs. (D9) to (D11)).
///
/// Light crosses each voxel along the mean chord of the direction, with exponential attenuation: stable and positive
/// for every optical thickness, and exact along an axis. Light leaves a voxel into its downwind neighbours with equal
/// radiance, so that power is conserved to rounding. For oblique directions light spreads across the direction, an
/// error of first order in the voxel edges. Weighted diamond differences (SweptSums::byDiamonds) are of second order
/// (Eq. (D15)), equally positive and conservative, but not linear where they have to keep light from becoming negative.
class UpwindSweep : public OrdinateSweep
{
public:
  UpwindSweep(Device& device, const Grid& grid, const OrdinateGroups& groups, const SweptFaces& faces);

  /// Bytes of device memory for the radiance through the faces.
  static std::size_t Bytes(const Grid& grid, const OrdinateGroups& groups);

  FacePowers Apply(
    const OrdinateArrays& arrays, const IncomingRadiance& incoming, bool shines, const Monitor& monitor) override;
  void Forget() override;
  /// Fraction of the groups of directions that carry incident light.
  double LitPart(const IncomingRadiance& incoming) const;

  /// Sweeps only the box, for an order without incident light and without sources outside of the box. The radiance that
  /// leaves the box is added to that of earlier such orders, for ApplyBeyond(). There must be no periodic axis and no
  /// reflecting face.
  /// @return power that leaves the box, through its own faces
  FacePowers ApplyWithin(const VoxelBox& box, const OrdinateArrays& arrays, const Monitor& monitor);
  /// Carries the radiance that left the box in all calls of ApplyWithin() on to the faces of the grid.
  /// @param arrays  radiance: 0 on entry outside of the box; on return the mean radiance of the voxels outside of it, 0
  ///   within
  FacePowers ApplyBeyond(const VoxelBox& box, const OrdinateArrays& arrays, const Monitor& monitor);

  // Steps of Apply(), for a pipeline over ranks: LetIn() sets the boundary source, SweepGroups() sweeps `count` groups
  // of directions, Count() and LeaveByCells() tally the outgoing power.
  void LetIn(const IncomingRadiance& incoming, FacePowers& powers, bool onlyWraps);
  void SweepGroups(int first, int count, const OrdinateArrays& arrays, const Monitor& monitor);
  void Count(FacePowers& powers) const;
  void LeaveByCells() const; ///< adds outgoing power by cell to SweptFaces::reflecting, if faces reflect

  /// Radiance through the faces perpendicular to an axis, [group][row][voxel of the row][8]: incident before the group
  /// is swept, outgoing afterwards. Rows are numbered by z or, in faces perpendicular to z, by y.
  std::vector<float> ReadFace(int axis, int firstGroup, int groups) const;
  void WriteFace(int axis, int firstGroup, const std::vector<float>& values);

private:
  bool IsCarried(int axis) const { return !this->At.unvarying[axis]; }
  /// Number of rows of a face perpendicular to `axis`, and number of voxels in a row.
  std::array<int, 2> FaceSize(int axis) const;
  void LoadDirections();
  bool IsCounted(int face) const { return !(this->At.inner >> face & 1); }
  void FillFace(int axis, const IncomingRadiance& incoming, FacePowers& powers);
  /// Index of the first cell of a face in SweptFaces::reflecting.
  cl_ulong CellOf(int face) const { return this->At.reflecting->first + LayoutOfFace(this->TheGrid, face).first; }
  void EnterByCells(int axis) const;
  cl::Kernel Kernel(const char* name, int width = 8) const;
  std::vector<bool> LitGroups(const IncomingRadiance& incoming) const;
  void Sweep(int first, int count, SweptLayers part, const OrdinateArrays& arrays, const Monitor& monitor);

  Device& TheDevice;
  Grid TheGrid;
  const OrdinateGroups& Groups;
  const SweptFaces At;
  Buffer<float> Shares, Across;
  Buffer<cl_int> Up;
  std::array<Buffer<float>, 3> Faces, Sums;
  std::array<Buffer<float>, 3> Left; ///< radiance that left the box of ApplyWithin(), summed over its calls; like Faces
};
}
