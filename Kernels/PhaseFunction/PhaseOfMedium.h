#pragma once

#include "Medium/Field.h"
#include "PhaseFunction/PhaseFunction.h"

#include <array>
#include <cstddef>

namespace tyndall
{
/// Phase function of a medium: one for all voxels, one per channel, or one kind with a mean cosine by voxel (e.g. a
/// mixture of droplets and haze).
class PhaseOfMedium
{
public:
  PhaseOfMedium() = default; ///< isotropic
  /// Implicit conversion: one phase function for all voxels and channels.
  PhaseOfMedium(const PhaseFunction& ofAll);
  explicit PhaseOfMedium(const std::array<PhaseFunction, 3>& ofChannels);
  /// @param kind  a kind with one mean cosine (PhaseFunction::WithMeanCosine), else InvalidInput is thrown
  /// @param g  mean cosine by voxel, which replaces that of `kind`; not owned
  PhaseOfMedium(const PhaseFunction& kind, const Field& g);

  const PhaseFunction& OfChannel(int channel) const { return this->Functions[channel]; } ///< only if g does not vary
  const Field& G() const { return this->ByVoxel; } ///< without values if g does not vary
  bool Varies() const { return this->ByVoxel.values != nullptr; }

  bool IsIsotropic() const; ///< as far as can be told without reading G()
  bool HasColour() const;
  double MeanCosine(std::size_t voxel, int channel) const
  {
    return this->Varies() ? this->ByVoxel.At(voxel, channel) : this->MeanCosines[channel];
  }
  PhaseFunction At(std::size_t voxel, int channel) const;
  /// The same kind of function with other mean cosines by voxel, on another grid.
  PhaseOfMedium WithG(const Field& g) const { return PhaseOfMedium(this->Functions[0], g); }
  /// The phase function of one channel, for a scene that is solved in one channel.
  PhaseOfMedium Seen(int channel) const;

private:
  std::array<PhaseFunction, 3> Functions;
  std::array<double, 3> MeanCosines = {};
  Field ByVoxel;
};
}
