#pragma once

#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Uncollided/Lamps/LampOnGrid.h"

namespace tyndall
{
/// What a lamp's beams put down, parts of its power in 64-bit fixed point, so that sums do not depend on the order of
/// their terms (numerics.md, Eq. (35)): path times length, and behind it first moments and net flux where a deposit
/// asks for them, [path, 3 first moments, 3 of flux][stride], and of a rectangle what vacuum would have;
/// and what leaves by cells of the grid's faces, where it does.
class LampSums
{
public:
  /// @param stride  voxels of an array
  /// @param grid  the whole, whose faces have the cells that a deposit asks for
  LampSums(Device& device, const LampOnGrid& lamp, const Deposit& deposit, std::size_t stride, const Grid& grid);

  static int Parts(const LampOnGrid& lamp, const Deposit& deposit)
  {
    return 1 + (deposit.firstMoments ? 3 : 0) + (deposit.flux ? 3 : 0) + lamp.SumsOfVacuum();
  }

  Buffer<cl_long>& Sums() { return this->Fixed; }
  Buffer<cl_long>& Cells() { return this->OfCells; } ///< BoxFaces.h, in units of LampPowerUnits; or one value
  std::size_t Stride() const { return this->TheStride; }

  /// Of a rectangle: finds by what each voxel's path is to be multiplied to be the exact one in vacuum
  /// (numerics.md, section 5.3), which AddTo does then.
  /// @param own  the voxels of the sums
  /// @return what these then take of the lamp's power, 0 of other lamps
  double FitToVacuum(const SweepVolume& volume, const LampOnGrid& lamp, const VoxelBox& own);

  /// Adds what is there, times the lamp's power, to the deposit's arrays.
  /// @param volume  its stride is that of the sums
  /// @param factor  of the lamp's power
  void AddTo(const SweepVolume& volume, const LampOnGrid& lamp, double factor) const;
  /// The same of the cells, to the deposit's that begin at `faceFirst`.
  void AddCellsTo(const SweepVolume& volume, std::size_t faceFirst, const LampOnGrid& lamp, double factor) const;

  /// In a box without faces thin light crosses all places alike in the end: so it goes to the deposit's path.
  /// @param share  of the lamp's power
  /// @param extinction  Extinction of the whole box
  /// @return false: nothing there takes any
  bool SpreadEvenly(const SweepVolume& volume, const LampOnGrid& lamp, double share, double extinction) const;

private:
  Device& TheDevice;
  Buffer<cl_long> Fixed, OfCells;
  Buffer<float> Gains; ///< by voxel; one value where there are none
  std::size_t TheStride;
};

/// sigma_t of all voxels of a volume, added up, 1/length.
double Extinction(const SweepVolume& volume);
}
