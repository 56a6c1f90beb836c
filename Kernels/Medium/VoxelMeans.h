#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Scalars on a lattice, `components` per site, x fastest, between which they are interpolated trilinearly. Sites with
/// a component that is not a number are empty.
struct ScalarLattice
{
  /// Where the sites lie, relative to the voxels.
  enum class Sites
  {
    Corners,      ///< at the corners of voxels: one site more than voxels along each axis
    Centres,      ///< at the centres of voxels; constant beyond the outermost sites, and beside an empty site
    CentresWithin ///< at the centres of voxels; empty beyond the outermost sites, along axes with several
  };

  const float* values = nullptr;
  int components = 1;
  std::array<int, 3> size = { 1, 1, 1 }; ///< number of sites per axis
  Sites sites = Sites::Centres;
  bool nearest = false; ///< whether a scalar is that of the nearest site, instead of interpolated
};

/// Coefficients of a medium as functions of scalars.
class ScalarCoefficients
{
public:
  virtual ~ScalarCoefficients() = default;
  virtual int ValueCount() const = 0; ///< coefficients, 1 to CoefficientTable::MostValues
  /// How often the slopes of the coefficients change between two values of each component; 0: they are linear there.
  virtual int KinksBetween(const double* low, const double* high) const = 0;
  /// Adds `weight` times the mean coefficients of a straight segment along which the scalars change linearly.
  /// @param from, to  scalars at its ends, one per component, finite
  virtual void AddMean(const double* from, const double* to, double weight, double* sums) const = 0;
};

/// Mean coefficients of each voxel: means of the functions over the voxel, not functions of the mean scalar.
///
/// A voxel consists of 8 octants, cut at the planes of the sites, in which scalars are trilinear. Along the axis on
/// which the scalars of the octant differ most, the means are those of `coefficients`, which may be exact. Across it a
/// Gauss quadrature of up to 3 x 3 points is used, the more points the more kinks the coefficients have in the octant.
/// Means are exact where coefficients are linear in the scalars, and where scalars vary along one axis only.
/// @return ValueCount() values per voxel, x fastest
std::vector<float> VoxelMeans(
  const ScalarLattice& lattice, const std::array<int, 3>& voxels, const ScalarCoefficients& coefficients);
}
