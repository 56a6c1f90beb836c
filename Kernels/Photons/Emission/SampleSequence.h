#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// Method that distributes the samples of photons in the unit hypercube (Pfeuti 2009, section 4.1).
enum class Sampler
{
  Hammersley = 0, ///< coordinates of point i: (i + 1/2) / count, radical inverses of i to the bases 2, 3, 5
  Halton = 1,     ///< coordinates of point i: radical inverses of i to the bases 2, 3, 5, 7
  Jittered = 2,   ///< one random point in each cell of a square grid
  Grid = 3,       ///< the centre of each cell of a square grid
  Random = 4,
};

/// Sequence of `count` points in the unit hypercube [0, 1)^4, reproducible for a given seed.
///
/// The cells of Grid and Jittered have equal areas for any count. Dimensions 0 and 1 form one grid, dimensions 2 and
/// 3 a second, whose cells are visited in another order. A nonzero seed shifts all points of Hammersley, Halton and
/// Grid by the same vector, modulo 1.
///
/// Batches with the same seed are independent point sets: each batch above 0 uses another shift. Odd batches also
/// exchange dimensions 0 and 1, and Hammersley's bases 2 and 3, so that the errors of an even and an odd batch are not
/// correlated.
class SampleSequence
{
public:
  SampleSequence(Sampler sampler, std::size_t count, std::uint64_t seed = 0, int batch = 0);

  std::array<double, 4> operator[](std::size_t i) const;

private:
  std::array<double, 2> Cell(std::size_t i, double across, double along) const;
  double Random(std::size_t i, int dimension) const;

  Sampler Kind;
  std::size_t Count;
  std::uint64_t Seed;
  bool Turned; ///< whether dimensions 0 and 1 are exchanged
  std::size_t Rows;
  std::size_t Stride; ///< step between the cells of the second grid that successive points use
  std::array<double, 4> Shift = {};
};

/// Inverts a cumulative table: returns the index of the step in which the fraction u of the total is reached, never a
/// step of zero height.
/// @param table  count + 1 non-decreasing values, the first 0, the last above 0
/// @param u      fraction of the total, [0, 1)
/// @param part   output: position of u * total within that step, [0, 1)
int FindStep(const double* table, int count, double u, double& part);

/// Map from the unit square to the cells of an image, which distributes uniform points in proportion to the image's
/// values. Rows are chosen by their marginal distribution, then columns by the row's conditional distribution.
class DensityTable
{
public:
  /// Builds the cumulative table of an image.
  /// @param weights  width * height non-negative weights of the cells, columns fastest
  DensityTable(int width, int height, const std::vector<double>& weights);

  /// A point in a cell of the image.
  struct Place
  {
    int column, row;
    double across, along; ///< position within the cell, [0, 1)
  };
  /// Maps the coordinates u (which chooses the column) and v (the row), in [0, 1), to a point. Total() must be above
  /// 0.
  Place At(double u, double v) const;

  double Total() const { return this->Rows.back(); }
  double WeightOf(int column, int row) const;

private:
  int Width, Height;
  /// Cumulative weights of rows, and of cells within each row, each with a leading zero.
  std::vector<double> Rows, Columns;
};
}
