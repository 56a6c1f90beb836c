#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace tyndall
{
/// How photons are spread (Pfeuti 2009, section 4.1).
enum class Sampler
{
  Hammersley = 0, ///< (i + 1/2) / count and radical inverses to the bases 2, 3, 5
  Halton = 1,     ///< radical inverses to the bases 2, 3, 5, 7
  Jittered = 2,   ///< a random point in each cell of a grid
  Grid = 3,       ///< the middle of each cell
  Random = 4,
};

/// `count` points of the unit hypercube [0, 1)^4, the same for the same seed.
///
/// Cells of Grid and Jittered have equal areas whatever the count is; in dimensions 2 and 3 they are a second grid, in
/// another order. A seed other than 0 shifts Hammersley, Halton and Grid as a whole, round the edges.
///
/// Batches of one seed are independent sets: each above 0 has a shift of its own; in odd ones dimensions 0 and 1 change
/// places, and so do Hammersley's bases 2 and 3, so that errors of an even and an odd one are unrelated.
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
  bool Turned; ///< dimensions 0 and 1 change places
  std::size_t Rows;
  std::size_t Stride; ///< from cell to cell of the second grid
  std::array<double, 4> Shift = {};
};
}
