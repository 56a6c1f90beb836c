#pragma once

#include "Device/ExactValues.h"
#include "LightPropagation/Diffusion/DiffusionShared.h"

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
    const Buffer<float>* sigma_s; ///< 1/length; below 0: the voxel is counted elsewhere, on the rank that it is of
    std::size_t first;            ///< where the coefficients of these values begin
    float length;
  };

  using Sums = std::array<double, AndersonSums>;

  /// @param given  what `found` was found with; becomes what to go on with
  /// @return |found - given| / |found| of each voxel's first value, weighted (numerics.md, Eq. (72))
  double Mix(const ExactValues& given, const ExactValues& found, const Weighting& weighting)
  {
    return this->Mix(given, found, this->SumsOf(given, found, weighting));
  }

  // The same in two steps, where values are spread over ranks: sums of all ranks lie between them.
  Sums SumsOf(const ExactValues& given, const ExactValues& found, const Weighting& weighting) const;
  double Mix(const ExactValues& given, const ExactValues& found, const Sums& sums);
  static double ChangeBy(const Sums& sums); ///< what Mix returns

private:
  cl::Kernel Kernel(const char* name) const;
  std::array<double, 2> WeightsBy(const Sums& sums) const;

  Device& TheDevice;
  std::size_t Voxels, Count;
  ExactValues OfChunks;
  std::array<Buffer<float>, 2> FoundBefore, ChangeBefore; ///< of the last mix and the one before
  int Mixes = 0;
};
}
