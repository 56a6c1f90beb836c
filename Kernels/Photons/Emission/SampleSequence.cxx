#include "Photons/Emission/SampleSequence.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace tyndall
{
namespace
{
/// Hash of x by splitmix64 (Steele, Lea, Flood 2014): every bit of the result depends on every bit of x.
std::uint64_t Mix(std::uint64_t x)
{
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

double Unit(std::uint64_t bits)
{
  return static_cast<double>(bits >> 11) * 0x1p-53;
}

double RadicalInverse(std::size_t i, std::size_t base)
{
  double inverse = 0.0;
  for (double digit = 1.0 / base; i > 0; digit /= base, i /= base)
  {
    inverse += digit * static_cast<double>(i % base);
  }
  return std::min(inverse, 1.0 - 0x1p-53);
}

/// Stride that visits each of 0 ... `count` - 1 once if it is added repeatedly modulo `count`. Successive values are
/// far apart.
std::size_t Scatter(std::size_t count)
{
  std::size_t stride = std::max<std::size_t>(static_cast<std::size_t>(0.6180339887498949 * count), 1);
  while (std::gcd(stride, count) != 1)
  {
    ++stride;
  }
  return stride;
}
}

SampleSequence::SampleSequence(Sampler sampler, std::size_t count, std::uint64_t seed, int batch)
  : Kind(sampler)
  , Count(std::max<std::size_t>(count, 1))
  , Seed(batch == 0 ? seed : Mix(seed) + static_cast<std::uint64_t>(batch))
  , Turned(batch % 2 == 1)
  , Rows(static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(this->Count)))))
  , Stride(Scatter(this->Count))
{
  for (int d = 0; d < 4 && this->Seed != 0; ++d)
  {
    this->Shift[d] = Unit(Mix(Mix(this->Seed) + d));
  }
}

double SampleSequence::Random(std::size_t i, int dimension) const
{
  return Unit(Mix(Mix(this->Seed + 1) ^ Mix(4 * static_cast<std::uint64_t>(i) + dimension)));
}

/// A point in cell i of a grid of Count cells. `across` and `along` are its position within the cell as fractions of
/// the cell's extent. The height of a row is proportional to its number of cells.
std::array<double, 2> SampleSequence::Cell(std::size_t i, double across, double along) const
{
  const std::size_t row = ((i + 1) * this->Rows - 1) / this->Count;
  const std::size_t begin = row * this->Count / this->Rows;
  const std::size_t end = (row + 1) * this->Count / this->Rows;
  const double cells = static_cast<double>(end - begin);
  return { (static_cast<double>(i - begin) + across) / cells,
    (begin + along * cells) / static_cast<double>(this->Count) };
}

std::array<double, 4> SampleSequence::operator[](std::size_t i) const
{
  std::array<double, 4> point;
  const bool cells = this->Kind == Sampler::Grid || this->Kind == Sampler::Jittered;
  if (cells)
  {
    const auto offset = [&](int d) { return this->Kind == Sampler::Grid ? 0.5 : this->Random(i, d); };
    const std::array<double, 2> first = this->Cell(i, offset(0), offset(1));
    const std::array<double, 2> second = this->Cell(i * this->Stride % this->Count, offset(2), offset(3));
    point = { first[0], first[1], second[0], second[1] };
  }
  else
  {
    constexpr std::size_t Bases[] = { 2, 3, 5, 7 };
    const bool otherBases = this->Turned && this->Kind == Sampler::Hammersley;
    const auto base = [&](int number) { return Bases[otherBases && number < 2 ? 1 - number : number]; };
    for (int d = 0; d < 4; ++d)
    {
      point[d] = this->Kind == Sampler::Random ? this->Random(i, d)
        : this->Kind == Sampler::Halton        ? RadicalInverse(i + 1, Bases[d])
        : d == 0                               ? (i + 0.5) / static_cast<double>(this->Count)
                                               : RadicalInverse(i, base(d - 1));
    }
  }
  const bool shifted = this->Kind != Sampler::Random && this->Kind != Sampler::Jittered;
  for (int d = 0; shifted && d < 4; ++d)
  {
    point[d] += this->Shift[d];
    point[d] -= std::floor(point[d]);
  }
  if (this->Turned)
  {
    std::swap(point[0], point[1]);
  }
  return point;
}

int FindStep(const double* table, int count, double u, double& part)
{
  const double wanted = u * table[count];
  int step = static_cast<int>(std::upper_bound(table + 1, table + count, wanted) - table) - 1;
  // If rounding has raised `wanted` to the total, uses the last step of nonzero height.
  while (step > 0 && table[step + 1] == table[step])
  {
    --step;
  }
  part = std::min(
    // At most 1 - 2^-40: a larger part could round step + part up to step + 1.
    (wanted - table[step]) / (table[step + 1] - table[step]), 1.0 - 0x1p-40);
  return step;
}

DensityTable::DensityTable(int width, int height, const std::vector<double>& weights)
  : Width(width)
  , Height(height)
  , Rows(static_cast<std::size_t>(height) + 1, 0.0)
  , Columns(static_cast<std::size_t>(height) * (width + 1), 0.0)
{
  auto weight = weights.begin();
  auto column = this->Columns.begin();
  for (std::size_t row = 0; row < static_cast<std::size_t>(height); ++row, weight += width, column += width + 1)
  {
    std::partial_sum(weight, weight + width, column + 1);
    this->Rows[row + 1] = this->Rows[row] + column[width];
  }
}

DensityTable::Place DensityTable::At(double u, double v) const
{
  Place place;
  place.row = FindStep(this->Rows.data(), this->Height, v, place.along);
  const double* const columns = this->Columns.data() + static_cast<std::size_t>(place.row) * (this->Width + 1);
  place.column = FindStep(columns, this->Width, u, place.across);
  return place;
}

double DensityTable::WeightOf(int column, int row) const
{
  const double* const columns = this->Columns.data() + static_cast<std::size_t>(row) * (this->Width + 1);
  return columns[column + 1] - columns[column];
}
}
