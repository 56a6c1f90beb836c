#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Number of the environment and the sky among lights; lights of their own are numbered from 0.
constexpr int EnvironmentLight = -1;

/// How densely photons are to start: a square picture for each light, of its photon plane or of what stands for it
/// (the first two coordinates of the samples that its photons are made of).
struct ImportanceMap
{
  int size = 0;               ///< cells along an edge of each square
  std::vector<int> lights;    ///< number of the light of each square, as EmittedPhotons has it
  std::vector<float> density; ///< size*size of each light, columns fastest; > 0, any scale

  int SquareOf(int light) const; ///< which square is a light's; -1: it has none
  std::size_t Cells() const { return static_cast<std::size_t>(this->size) * static_cast<std::size_t>(this->size); }
};

/// @throws InvalidInput where a density is negative, 0 (then the light that starts there would be missing) or not
///   finite (names light, column and row), or their number is not that of the cells
void Check(const ImportanceMap& map);

/// One light's square of a map: the unit square is mapped onto itself such that what is spread evenly over it becomes
/// as dense as the map (Pfeuti 2009, section 3.2.3): rows by their marginal distribution, then columns by that of the
/// row.
class ImportanceSampler
{
public:
  /// @param density  size*size, not all zero
  /// @param most     density at most, in those of photons spread evenly, at least 1: what a cell has above it is shared
  ///                 by the others in proportion
  ImportanceSampler(const float* density, int size, double most);

  /// A place of the unit square, and its probability density there.
  struct Place
  {
    double u, v, density;
  };
  Place At(double u, double v) const;

  double DensityOf(int column, int row) const; ///< probability density in a cell: 1 on the mean

private:
  int Size;
  std::vector<double> Rows, Columns; ///< cumulative, each with a zero before
};
}
