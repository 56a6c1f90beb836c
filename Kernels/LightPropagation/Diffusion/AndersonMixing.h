#pragma once

#include "Device/ExactValues.h"
#include "LightPropagation/Diffusion/DiffusionShared.h"

#include <array>

namespace tyndall
{
/// Anderson mixing of an iteration's last three results (D. G. Anderson, Iterative Procedures for Nonlinear Integral
/// Equations, J. ACM 12, 1965; numerics.md, Eq. (71)). It speeds up convergence and damps oscillation: the next x is
/// the combination of the results with the least change in the least-squares sense.
class AndersonMixing
{
public:
  /// @param voxels  number of voxels
  /// @param count  number of values: one or several arrays of one value a voxel, one after the other
  AndersonMixing(Device& device, std::size_t voxels, std::size_t count, const char* what);

  /// Weight of a voxel in the norm of the change: tau / (1 + tau), tau = sigma_s length (numerics.md, Eq. (72)); 0 in
  /// vacuum, which does not scatter.
  struct Weighting
  {
    const Buffer<float>* sigma_s; ///< 1/length; below 0: a ghost voxel, excluded because it is counted by its owner
    std::size_t first;            ///< offset of the values' coefficients in sigma_s
    float length;
  };

  using Sums = std::array<double, AndersonSums>;

  /// Sums over this rank's values; Mix() takes those of all ranks.
  Sums SumsOf(const ExactValues& given, const ExactValues& found, const Weighting& weighting) const;
  /// @param given  the input that led to the result `found`; replaced by the next input
  void Mix(const ExactValues& given, const ExactValues& found, const Sums& sums);
  /// |found - given| / |found| over each voxel's first value, weighted (numerics.md, Eq. (72)).
  static double ChangeBy(const Sums& sums);

private:
  cl::Kernel Kernel(const char* name) const;
  std::array<double, 2> WeightsBy(const Sums& sums) const;

  Device& TheDevice;
  std::size_t Voxels, Count;
  ExactValues OfChunks;
  /// Result and change of the last mix and of the one before it.
  std::array<Buffer<float>, 2> FoundBefore, ChangeBefore;
  int Mixes = 0;
};
}
