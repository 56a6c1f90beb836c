#include "Medium/VoxelMeans.h"

#include "Device/HostThreads.h"
#include "Medium/Grid.h"
#include "Numerics/Legendre.h"

#include <algorithm>
#include <cmath>

namespace tyndall
{
namespace
{
constexpr int MostComponents = 4;
constexpr int MostPoints = 3; ///< of the quadrature along each of two axes in an octant

using Scalars = std::array<double, MostComponents>;

Scalars Between(const Scalars& low, const Scalars& high, double part)
{
  Scalars between;
  for (int c = 0; c < MostComponents; ++c)
  {
    between[c] = low[c] + part * (high[c] - low[c]);
  }
  return between;
}

/// Scalars of one voxel at 3 x 3 x 3 places: its corners, and the middles of its edges and faces and of itself.
class VoxelScalars
{
public:
  VoxelScalars(const ScalarLattice& lattice, const std::array<int, 3>& voxel)
    : Lattice(lattice)
    , Voxel(voxel)
  {
    const bool areCorners = lattice.sites == ScalarLattice::Sites::Corners;
    for (int i = 0; i < 27; ++i)
    {
      const std::array<int, 3> at = { i % 3, i / 3 % 3, i / 9 };
      const bool isSite = !areCorners || (at[0] != 1 && at[1] != 1 && at[2] != 1);
      if (isSite)
      {
        this->Places[i] = this->Site(at);
      }
    }
    for (int axis = 0; axis < 3; ++axis)
    {
      areCorners ? this->FillMiddles(axis) : this->MoveToFaces(axis);
    }
  }

  /// Scalars at the corners of an octant, by x + 2 y + 4 z.
  std::array<Scalars, 8> Octant(int x, int y, int z) const
  {
    std::array<Scalars, 8> corners;
    for (int i = 0; i < 8; ++i)
    {
      corners[i] = this->Places[(x + (i & 1)) + 3 * (y + (i >> 1 & 1)) + 9 * (z + (i >> 2))];
    }
    return corners;
  }

  /// Whether half a voxel, lower (0) or upper (1), has no medium because it is beyond the outermost sites.
  bool IsBeyond(int axis, int side) const
  {
    const int last = this->Lattice.size[axis] - 1;
    return this->Lattice.sites == ScalarLattice::Sites::CentresWithin && last > 0 &&
      this->Voxel[axis] == (side == 0 ? 0 : last);
  }

private:
  /// Scalars of the voxel's corner, or of the neighbouring voxel, at a place.
  Scalars Site(const std::array<int, 3>& at) const
  {
    std::array<int, 3> site;
    for (int axis = 0; axis < 3; ++axis)
    {
      site[axis] = this->Lattice.sites == ScalarLattice::Sites::Corners
        ? this->Voxel[axis] + at[axis] / 2
        : std::clamp(this->Voxel[axis] + at[axis] - 1, 0, this->Lattice.size[axis] - 1);
    }
    Scalars scalars = {};
    const std::size_t first = Grid{ this->Lattice.size }.IndexOf(site) * this->Lattice.components;
    std::copy_n(this->Lattice.values + first, this->Lattice.components, scalars.begin());
    return scalars;
  }

  template <class Act>
  static void ForLines(int axis, const Act& act)
  {
    constexpr int strides[3] = { 1, 3, 9 };
    for (int i = 0; i < 27; ++i)
    {
      if (i / strides[axis] % 3 == 0)
      {
        act(i, i + strides[axis], i + 2 * strides[axis]);
      }
    }
  }

  void FillMiddles(int axis)
  {
    ForLines(axis, [&](int low, int middle, int high) {
      this->Places[middle] = Between(this->Places[low], this->Places[high], 0.5);
    });
  }

  void MoveToFaces(int axis)
  {
    ForLines(axis, [&](int low, int middle, int high) {
      this->Places[low] = Between(this->Places[low], this->Places[middle], 0.5);
      this->Places[high] = Between(this->Places[middle], this->Places[high], 0.5);
    });
  }

  const ScalarLattice& Lattice;
  std::array<int, 3> Voxel;
  std::array<Scalars, 27> Places = {};
};

bool AreNumbers(const float* values, int count)
{
  return std::all_of(values, values + count, [](float value) { return std::isfinite(value); });
}

/// Number of quadrature points along each of two axes: one is exact for coefficients that are linear in the scalars.
int PointsFor(int kinks)
{
  return kinks == 0 ? 1 : kinks <= 16 ? 2 : MostPoints;
}

/// Axis along which the scalars of an octant differ most.
int SteepestAxis(const std::array<Scalars, 8>& corners, int components)
{
  std::array<double, 3> differences = {};
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int i = 0; i < 8; ++i)
    {
      for (int c = 0; c < components; ++c)
      {
        differences[axis] += std::abs(corners[i][c] - corners[i ^ (1 << axis)][c]);
      }
    }
  }
  return static_cast<int>(std::max_element(differences.begin(), differences.end()) - differences.begin());
}

/// Adds the mean coefficients of an octant to `sums`, times its fraction of the voxel. Segments are parallel to the
/// axis along which the scalars differ most, with the quadrature across it.
void AddOctant(
  const std::array<Scalars, 8>& corners, int components, const ScalarCoefficients& coefficients, double* sums)
{
  static const std::array<GaussLegendre, MostPoints> quadratures = { GaussLegendre(1), GaussLegendre(2),
    GaussLegendre(3) };
  Scalars low = corners[0], high = corners[0];
  for (const Scalars& corner : corners)
  {
    for (int c = 0; c < components; ++c)
    {
      low[c] = std::min(low[c], corner[c]);
      high[c] = std::max(high[c], corner[c]);
      if (!std::isfinite(corner[c]))
      {
        return;
      }
    }
  }
  const GaussLegendre& quadrature = quadratures[PointsFor(coefficients.KinksBetween(low.data(), high.data())) - 1];
  const PlaneAxes axes = AcrossAxis(SteepestAxis(corners, components));
  const int along = 1 << axes.axis, u = 1 << axes.u, v = 1 << axes.v;
  for (std::size_t j = 0; j < quadrature.points.size(); ++j)
  {
    const double atV = 0.5 + 0.5 * quadrature.points[j];
    const std::array<Scalars, 2> lower = { Between(corners[0], corners[v], atV),
      Between(corners[along], corners[along + v], atV) };
    const std::array<Scalars, 2> upper = { Between(corners[u], corners[u + v], atV),
      Between(corners[u + along], corners[u + along + v], atV) };
    for (std::size_t i = 0; i < quadrature.points.size(); ++i)
    {
      const double atU = 0.5 + 0.5 * quadrature.points[i];
      const Scalars from = Between(lower[0], upper[0], atU), to = Between(lower[1], upper[1], atU);
      const double weight = 0.25 * quadrature.weights[i] * quadrature.weights[j];
      coefficients.AddMean(from.data(), to.data(), 0.125 * weight, sums);
    }
  }
}

/// Means of single voxels.
class MeansOfVoxel
{
public:
  MeansOfVoxel(const ScalarLattice& lattice, const ScalarCoefficients& coefficients)
    : Lattice(lattice)
    , Coefficients(coefficients)
  {
  }

  /// Adds the means of a voxel to `sums`.
  void Add(const std::array<int, 3>& voxel, double* sums) const
  {
    const bool areCentres = this->Lattice.sites == ScalarLattice::Sites::Centres;
    if (this->Lattice.nearest || (areCentres && this->IsBesideEmpty(voxel)))
    {
      this->AddNearest(voxel, sums);
      return;
    }
    const VoxelScalars scalars(this->Lattice, voxel);
    for (int octant = 0; octant < 8; ++octant)
    {
      const int x = octant & 1, y = octant >> 1 & 1, z = octant >> 2;
      if (!scalars.IsBeyond(0, x) && !scalars.IsBeyond(1, y) && !scalars.IsBeyond(2, z))
      {
        AddOctant(scalars.Octant(x, y, z), this->Lattice.components, this->Coefficients, sums);
      }
    }
  }

private:
  const float* Site(int x, int y, int z) const
  {
    return this->Lattice.values + Grid{ this->Lattice.size }.IndexOf({ x, y, z }) * this->Lattice.components;
  }

  /// Adds the coefficients of the nearest site of each octant: the voxel's own one, or a corner.
  void AddNearest(const std::array<int, 3>& voxel, double* sums) const
  {
    const bool areCorners = this->Lattice.sites == ScalarLattice::Sites::Corners;
    const VoxelScalars scalars(this->Lattice, voxel);
    for (int octant = 0; octant < 8; ++octant)
    {
      const std::array<int, 3> side = { octant & 1, octant >> 1 & 1, octant >> 2 };
      const float* const site = areCorners ? this->Site(voxel[0] + side[0], voxel[1] + side[1], voxel[2] + side[2])
                                           : this->Site(voxel[0], voxel[1], voxel[2]);
      const bool isBeyond =
        scalars.IsBeyond(0, side[0]) || scalars.IsBeyond(1, side[1]) || scalars.IsBeyond(2, side[2]);
      if (!isBeyond && AreNumbers(site, this->Lattice.components))
      {
        double own[MostComponents];
        std::copy(site, site + this->Lattice.components, own);
        this->Coefficients.AddMean(own, own, 0.125, sums);
      }
    }
  }

  /// Whether a site next to a voxel, or its own, is empty.
  bool IsBesideEmpty(const std::array<int, 3>& voxel) const
  {
    const auto low = [&](int axis) { return std::max(voxel[axis] - 1, 0); };
    const auto high = [&](int axis) { return std::min(voxel[axis] + 1, this->Lattice.size[axis] - 1); };
    for (int z = low(2); z <= high(2); ++z)
    {
      for (int y = low(1); y <= high(1); ++y)
      {
        if (!AreNumbers(this->Site(low(0), y, z), (high(0) - low(0) + 1) * this->Lattice.components))
        {
          return true;
        }
      }
    }
    return false;
  }

  const ScalarLattice& Lattice;
  const ScalarCoefficients& Coefficients;
};
}

std::vector<float> VoxelMeans(
  const ScalarLattice& lattice, const std::array<int, 3>& voxels, const ScalarCoefficients& coefficients)
{
  const Grid grid = { voxels };
  const std::size_t count = static_cast<std::size_t>(coefficients.ValueCount());
  std::vector<float> means(grid.VoxelCount() * count);
  const MeansOfVoxel ofVoxel(lattice, coefficients);
  InThreads(grid.VoxelCount(), 1024, [&](std::size_t begin, std::size_t end) {
    std::vector<double> sums(count);
    for (std::size_t i = begin; i < end; ++i)
    {
      std::fill(sums.begin(), sums.end(), 0.0);
      ofVoxel.Add(grid.VoxelAt(i), sums.data());
      std::copy(sums.begin(), sums.end(), means.begin() + i * count);
    }
  });
  return means;
}
}
