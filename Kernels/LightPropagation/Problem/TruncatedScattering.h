#pragma once

#include "LightPropagation/Problem/DirectionKernel.h"
#include "Medium/Medium.h"
#include "PhaseFunction/DeltaM.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tyndall
{
/// A medium's scattering as sweeps carry it: of each voxel the forward peak is taken as light that goes straight on
/// (DeltaM.h), and the rest has moments up to a degree. A voxel that is optically thick has a lower degree than the
/// others, down to 0: within it light forgets where it came from (numerics.md, section 2.2). Coefficients in 1/length.
class TruncatedScattering
{
public:
  /// @param medium  must stay
  /// @param degree  of the voxels that are thin; 0: all are isotropic, by the similarity relation
  /// @param nowhereNegative  directions between which nothing negative is scattered (WithoutNegatives); null: moments
  ///   are as delta-M has them
  TruncatedScattering(const Medium& medium, int degree, int channels, const DirectionKernel* nowhereNegative = nullptr);

  int Degree() const { return this->MostDegree; } ///< the highest of any voxel
  /// Of a block of a larger medium, whose highest degree is this one: at least its own, at most that which it was made
  /// with.
  void RaiseDegree(int degree) { this->MostDegree = degree; }
  std::vector<std::string> LeftOut() const; ///< of the medium's scattering, in words, where it does
  bool IsNowhereNegative() const { return this->NowhereNegative && this->MostDegree > 0; }

  float SigmaS(std::size_t voxel, int channel) const;
  float SigmaT(std::size_t voxel, int channel) const
  {
    return this->TheMedium.sigma_a.At(voxel, channel) + this->SigmaS(voxel, channel);
  }
  /// sigma_s of degree l: that, times the moment of what is scattered. 0 beyond the voxel's degree.
  float SigmaS(std::size_t voxel, int channel, int l) const;
  /// Part of what is scattered that goes straight on; 0 where nothing is.
  float StraightOn(std::size_t voxel, int channel) const;
  /// Of voxels whose degree is the highest, in the first channel; where g does not vary.
  const DeltaM& OfThinVoxels() const { return this->OfChannel[0][this->MostDegree]; }
  int DegreeOf(std::size_t voxel, int channel) const
  {
    return this->Degrees.empty() ? 0 : this->Degrees[voxel * this->Channels + channel];
  }

private:
  int FittingDegree(std::size_t voxel, int channel, double shortest) const;
  template <class Value>
  double Of(std::size_t voxel, int channel, int degree, const Value& value) const;
  double Forward(std::size_t voxel, int channel, int degree) const;

  const Medium& TheMedium;
  int MostDegree;
  int Channels;
  bool NowhereNegative;
  std::array<std::vector<DeltaM>, 3> OfChannel; ///< by degree; where g does not vary by voxel
  std::vector<std::vector<DeltaM>> OfG;         ///< where it varies: by g, evenly from -1 to 1, then by degree
  std::vector<std::uint8_t> Degrees;            ///< [voxel][channel]; empty: all 0
};
}
