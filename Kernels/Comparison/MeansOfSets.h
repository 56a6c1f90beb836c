#pragma once

#include <vector>

namespace tyndall
{
/// Means of independent sets of photons, and how far chance puts them off.
class MeansOfSets
{
public:
  /// @param channels  1 or 3; light of one channel stands for all
  void Add(const std::vector<float>& values, int channels);

  int Count() const { return this->Sets; }
  int Channels() const { return this->OfVoxel; } ///< the most of all sets
  std::vector<float> Values() const;

  /// Sum of the squares of the standard errors; needs two sets.
  double Variance() const;
  double SumOfSquares() const; ///< of the means
  /// Root of the mean square of the standard errors, over that of the means.
  double RelativeError() const;

  /// How far other light of the same voxels is off by at least, squared: its distance from the means, less what chance
  /// makes of that and twice the standard deviation of it.
  double SquaredErrorOf(const std::vector<float>& other, int channels) const;

private:
  void Widen(int channels);

  std::vector<double> Sums, Squares;
  int Sets = 0, OfVoxel = 1;
};
}
