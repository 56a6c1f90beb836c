#pragma once

#include <vector>

namespace tyndall
{
/// Means over independent sets of photons, and their standard errors.
class MeansOfSets
{
public:
  /// @param channels  1 or 3; light of one channel is used for all channels
  void Add(const std::vector<float>& values, int channels);

  int Count() const { return this->Sets; }
  int Channels() const { return this->OfVoxel; } ///< largest number of channels of any set
  std::vector<float> Values() const;

  /// Sum of the squared standard errors; needs at least two sets.
  double Variance() const;
  double SumOfSquares() const; ///< sum of the squared means
  /// Root mean square of the standard errors over that of the means.
  double RelativeError() const;

  /// Lower estimate of the squared error of other light on the same voxels: its squared distance from the means, less
  /// the expected statistical part and twice the standard deviation of that.
  double SquaredErrorOf(const std::vector<float>& other, int channels) const;

private:
  void Widen(int channels);

  std::vector<double> Sums, Squares;
  int Sets = 0, OfVoxel = 1;
};
}
