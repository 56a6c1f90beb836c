#pragma once

#include "Medium/Field.h"
#include "PhaseFunction/PhaseFunction.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// How the voxels of a medium scatter: all alike, each channel in its own way, or with a mean cosine that varies by
/// voxel (a mixture of droplets and haze).
class PhaseOfMedium
{
public:
  PhaseOfMedium() = default; ///< isotropic
  /// Converts: a phase function is that of a medium.
  PhaseOfMedium(const PhaseFunction& ofAll);
  explicit PhaseOfMedium(const std::array<PhaseFunction, 3>& ofChannels);
  /// @param kind  of one mean cosine (PhaseFunction::WithMeanCosine), else InvalidInput
  /// @param g     mean cosine by voxel, which replaces that of `kind`; seen, not owned
  PhaseOfMedium(const PhaseFunction& kind, const Field& g);

  const PhaseFunction& OfChannel(int channel) const { return this->Functions[channel]; } ///< where g does not vary
  const Field& G() const { return this->ByVoxel; } ///< without values where it does not vary
  bool Varies() const { return this->ByVoxel.values != nullptr; }

  bool IsIsotropic() const; ///< as far as is known without a look at G()
  bool HasColour() const;
  double MeanCosine(std::size_t voxel, int channel) const
  {
    return this->Varies() ? this->ByVoxel.At(voxel, channel) : this->MeanCosines[channel];
  }
  PhaseFunction At(std::size_t voxel, int channel) const;
  /// The same kind of function with other mean cosines by voxel, on another grid.
  PhaseOfMedium WithG(const Field& g) const { return PhaseOfMedium(this->Functions[0], g); }
  /// As one channel sees it, for a scene that is solved in one.
  PhaseOfMedium Seen(int channel) const;

private:
  std::array<PhaseFunction, 3> Functions;
  std::array<double, 3> MeanCosines = {};
  Field ByVoxel;
};
}
