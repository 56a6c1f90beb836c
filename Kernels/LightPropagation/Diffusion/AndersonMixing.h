#pragma once

#include "Device/ExactValues.h"
#include "LightPropagation/Diffusion/DiffusionShared.h"

#include <array>

namespace tyndall
{
/// Anderson mixing of the last three results of a fixed-point iteration (D. G. Anderson, Iterative Procedures for
/// Nonlinear Integral Equations, J. ACM 12, 1965; numerics.md, Eq. (71)). It speeds up convergence and damps
/// oscillation: the next input is the linear combination of the results whose change is smallest in the least-squares
/// sense.
class AndersonMixing
{
public:
  /// @param voxels  number of voxels
  /// @param count  number of values that are mixed: `voxels` times the number of consecutive arrays (fluence, then
  ///   moments) with one value per voxel
  AndersonMixing(Device& device, std::size_t voxels, std::size_t count, const char* what);

  /// Parameters of a voxel's weight in the norm of the change (numerics.md, Eq. (72)). The weight is tau / (1 + tau),
  /// with tau = sigma_s length; 0 without scattering.
  struct Weighting
  {
    /// Scattering coefficient, 1/length; below 0 in ghost voxels, which are excluded from sums because the ranks that
    /// own them add their values.
    const Buffer<float>* sigma_s;
    std::size_t first; ///< offset of the first voxel's value in sigma_s
    float length;
  };

  using Sums = std::array<double, AndersonSums>;

  /// Computes the sums of anderson_sums (AndersonMixing.cl) over this rank's values. Mix() needs them summed over all
  /// ranks.
  Sums SumsOf(const ExactValues& given, const ExactValues& found, const Weighting& weighting) const;
  /// Computes the input of the next iteration.
  /// @param given  the input of the iteration whose result is `found`; replaced by the next input
  /// @param sums  SumsOf(), summed over all ranks
  void Mix(const ExactValues& given, const ExactValues& found, const Sums& sums);
  /// Relative change |found - given| / |found|, in the weighted norm over each voxel's first value (numerics.md, Eq.
  /// (72)).
  static double ChangeBy(const Sums& sums);

private:
  cl::Kernel Kernel(const char* name) const;
  std::array<double, 2> WeightsBy(const Sums& sums) const;

  Device& TheDevice;
  std::size_t Voxels, Count;
  ExactValues OfChunks;
  /// Results, and changes found - given, of the previous iteration (index 0) and of the one before it (index 1).
  std::array<Buffer<float>, 2> FoundBefore, ChangeBefore;
  int Mixes = 0;
};
}
