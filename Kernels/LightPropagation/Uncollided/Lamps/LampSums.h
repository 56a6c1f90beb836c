#pragma once

#include "LightPropagation/Sweep/SweepVolume.h"
#include "LightPropagation/Uncollided/Lamps/LampOnGrid.h"

namespace tyndall
{
/// Sums of a lamp's deposits, as fractions of the traced power (LampOnGrid::Share). They are in 64-bit fixed point, so
/// that they do not depend on the order of their terms (numerics.md, Eq. (35)). Per voxel they are the path integral;
/// first moments and net flux, if the deposit has them; for a rectangle, also its path integral in vacuum. The layout
/// is [path, 3 first moments, 3 of flux, ...][voxel]. If the deposit has faceOut, also the power that escapes through
/// each cell of the grid's faces.
class LampSums
{
public:
  /// @param stride  number of voxels in each array
  /// @param grid  the whole grid, not a block
  LampSums(Device& device, const LampOnGrid& lamp, const Deposit& deposit, std::size_t stride, const Grid& grid);

  static int Parts(const LampOnGrid& lamp, const Deposit& deposit)
  {
    return 1 + (deposit.firstMoments ? 3 : 0) + (deposit.flux ? 3 : 0) + lamp.SumsOfVacuum();
  }

  Buffer<cl_long>& Sums() { return this->Fixed; }
  /// Escaped power per cell of the faces (BoxFaces.h), in fixed point (LampPowerUnits); a single unused value if it is
  /// not summed.
  Buffer<cl_long>& Cells() { return this->OfCells; }
  std::size_t Stride() const { return this->TheStride; }

  /// For a rectangle: computes the factors by which each voxel's path must be multiplied to be exact in vacuum
  /// (numerics.md, Eq. (34a)). AddTo() applies them.
  /// @param own  voxels that the sums cover
  /// @return fraction of the traced power that these voxels then remove; 0 for other lamps
  double FitToVacuum(const SweepVolume& volume, const LampOnGrid& lamp, const VoxelBox& own);

  /// Converts the sums, which are fractions of the traced power, to W and adds them to the arrays of the volume's
  /// deposit.
  /// @param volume  its arrays have as many values per channel as the sums
  /// @param factor  LampFactors::taken
  void AddTo(const SweepVolume& volume, const LampOnGrid& lamp, double factor) const;
  /// Converts the sums of escaped power per cell of the faces to W and adds them to the deposit's faceOut.
  /// @param faceFirst  index of the first channel's first cell in faceOut
  void AddCellsTo(const SweepVolume& volume, std::size_t faceFirst, const LampOnGrid& lamp, double factor) const;

  /// Adds light uniformly to the deposit's path. This is the limit of light that has wrapped many times around a box
  /// that is periodic along all axes.
  /// @param share  fraction of the lamp's power
  /// @param extinction  sum of sigma_t over all voxels of the domain (Extinction()), 1/length; if it is 0, nothing is
  /// added
  void SpreadEvenly(const SweepVolume& volume, const LampOnGrid& lamp, double share, double extinction) const;

private:
  Device& TheDevice;
  Buffer<cl_long> Fixed, OfCells;
  Buffer<float> Gains; ///< factor for each voxel's path, FitToVacuum(); a single value for lamps other than rectangles
  std::size_t TheStride;
};

/// Sum of sigma_t over all voxels of a volume, 1/length.
double Extinction(const SweepVolume& volume);
}
