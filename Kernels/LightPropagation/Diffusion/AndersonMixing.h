#pragma once

#include "Device/ExactValues.h"

#include <array>

namespace tyndall
{
/// Anderson's mixing of an iteration's last three results (D. G. Anderson, Iterative Procedures for Nonlinear Integral
/// Equations, J. ACM 12, 1965; numerics.md, Eq. (71)), so that it converges sooner and without swinging: the next x is
/// the combination of results whose change is least in the least squares.
class AndersonMixing
{
public:
  /// @param count  values, of one voxel after the other, as often as there are several of each
  AndersonMixing(Device& device, std::size_t voxels, std::size_t count, const char* what);

  /// How much a value counts in the change: tau / (1 + tau), tau = sigma_s length (numerics.md, Eq. (72)). 0 in vacuum,
  /// which scatters nothing.
  struct Weighting
  {
    const Buffer<float>* sigma_s; ///< 1/length
    std::size_t first;            ///< where the coefficients of these values begin
    float length;
  };

  /// @param given  what `found` was found with; becomes what to go on with
  /// @return |found - given| / |found| of each voxel's first value, weighted (numerics.md, Eq. (72))
  double Mix(const ExactValues& given, const ExactValues& found, const Weighting& weighting);

private:
  std::array<double, 2> Weights(
    const ExactValues& given, const ExactValues& found, const Weighting& weighting, double* change);

  Device& TheDevice;
  std::size_t Voxels, Count;
  ExactValues Sums;
  std::array<Buffer<float>, 2> FoundBefore, ChangeBefore; ///< of the last mix and the one before
  int Mixes = 0;
};
}
