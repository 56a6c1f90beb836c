#include "Comparison/MeansOfSets.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tyndall
{
namespace
{
/// Index, in an array with `has` channels, of the value with this index in an array with `wanted` channels.
std::size_t PlaceOf(std::size_t index, int has, int wanted)
{
  return has == wanted ? index : index / static_cast<std::size_t>(wanted);
}
}

/// Expands sums of one channel to all channels.
void MeansOfSets::Widen(int channels)
{
  const auto widened = [channels](const std::vector<double>& values) {
    std::vector<double> all(values.size() * static_cast<std::size_t>(channels));
    for (std::size_t i = 0; i < all.size(); ++i)
    {
      all[i] = values[PlaceOf(i, 1, channels)];
    }
    return all;
  };
  this->Sums = widened(this->Sums);
  this->Squares = widened(this->Squares);
  this->OfVoxel = channels;
}

void MeansOfSets::Add(const std::vector<float>& values, int channels)
{
  if (channels > this->OfVoxel)
  {
    this->Widen(channels);
  }
  const std::size_t size = values.size() / static_cast<std::size_t>(channels) * static_cast<std::size_t>(this->OfVoxel);
  this->Sums.resize(size);
  this->Squares.resize(size);
  for (std::size_t i = 0; i < size; ++i)
  {
    const double value = values[PlaceOf(i, channels, this->OfVoxel)];
    this->Sums[i] += value;
    this->Squares[i] += value * value;
  }
  ++this->Sets;
}

std::vector<float> MeansOfSets::Values() const
{
  std::vector<float> means(this->Sums.size());
  std::transform(this->Sums.begin(), this->Sums.end(), means.begin(),
    [this](double sum) { return static_cast<float>(sum / this->Sets); });
  return means;
}

double MeansOfSets::Variance() const
{
  double variance = 0.0;
  for (std::size_t i = 0; i < this->Sums.size(); ++i)
  {
    const double mean = this->Sums[i] / this->Sets;
    variance += std::max(0.0, this->Squares[i] / this->Sets - mean * mean) / (this->Sets - 1);
  }
  return variance;
}

double MeansOfSets::SumOfSquares() const
{
  double squares = 0.0;
  for (double sum : this->Sums)
  {
    squares += sum / this->Sets * sum / this->Sets;
  }
  return squares;
}

double MeansOfSets::RelativeError() const
{
  const double squares = this->SumOfSquares();
  return squares > 0.0 ? std::sqrt(this->Variance() / squares) : 0.0;
}

double MeansOfSets::SquaredErrorOf(const std::vector<float>& other, int channels) const
{
  const int most = std::max(channels, this->OfVoxel);
  const std::size_t size = other.size() / static_cast<std::size_t>(channels) * static_cast<std::size_t>(most);
  double distance = 0.0;
  for (std::size_t i = 0; i < size; ++i)
  {
    const double difference =
      this->Sums[PlaceOf(i, this->OfVoxel, most)] / this->Sets - other[PlaceOf(i, channels, most)];
    distance += difference * difference * this->OfVoxel / most;
  }
  const double deviation = std::sqrt((2.0 + 2.0 / (this->Sets - 1.0)) / static_cast<double>(this->Sums.size()));
  return std::max(distance - (1.0 + 2.0 * deviation) * this->Variance(), 0.0);
}
}
