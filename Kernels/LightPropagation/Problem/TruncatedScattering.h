#pragma once

#include "Device/Buffer.h"
#include "LightPropagation/Angular/DirectionSet.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "Medium/Medium.h"
#include "PhaseFunction/PhaseFunction.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace tyndall
{
/// Phase function between the directions of a quadrature as given by a series of angular moments (numerics.md, section
/// 2.3). For a truncated forward peak it is negative for some pairs of directions.
class DirectionKernel
{
public:
  /// @param degree  degree of the moments, at most MostDegree(set)
  DirectionKernel(const DirectionSet& set, int degree);

  /// Minimum of the phase function (mean 1) for scattering into any direction of the set, from directions of the set
  /// and from intermediate ones.
  /// @param moments  moments from degree 0 on, at most up to the degree of the kernel
  double Least(const std::vector<double>& moments) const;

private:
  int Degrees;
  std::vector<float> Parts; ///< contribution of a moment of 1 to the phase function, [pair of directions][degree]
};

/// Removes negative values of a truncated phase function on a quadrature (numerics.md, Eq. (8d)). Returns `truncated`
/// unchanged if it has none. Otherwise its moments of degree l are multiplied by exp(-s l (l + 1)), with the smallest s
/// that suffices, and the unscattered fraction is adjusted so that the mean cosine does not change.
DeltaM WithoutNegatives(const DeltaM& truncated, const DirectionKernel& kernel);

/// Delta-M scattering of a medium, as used by sweeps (PhaseFunction.h): in each voxel the forward peak is treated as
/// unscattered light, and the remainder has moments up to a degree. Optically thick voxels have a lower degree, down to
/// 0, since light loses its directional information within them (numerics.md, section 2.2). Coefficients are in
/// 1/length.
class TruncatedScattering
{
public:
  /// @param medium  must outlive this object
  /// @param degree  degree in optically thin voxels; 0: all scattering is isotropic, by the similarity relation
  /// @param nowhereNegative  quadrature on which the phase function is kept nonnegative (WithoutNegatives); null:
  ///   moments of delta-M, which may be negative in some directions
  TruncatedScattering(const Medium& medium, int degree, int channels, const DirectionKernel* nowhereNegative = nullptr);

  int Degree() const { return this->MostDegree; } ///< highest degree of the angular moments of any voxel
  /// If the medium is a subdomain: sets the highest degree of any voxel to that of the domain, which lies between the
  /// degree of the subdomain and the degree given to the constructor.
  void RaiseDegree(int degree) { this->MostDegree = degree; }
  /// Descriptions, for LightField::leftOut, of simplifications of the medium's scattering; empty if there are none.
  std::vector<std::string> LeftOut() const;
  bool IsNowhereNegative() const { return this->NowhereNegative && this->MostDegree > 0; }

  /// Scattering coefficient without the forward peak.
  float SigmaS(std::size_t voxel, int channel) const;
  float SigmaT(std::size_t voxel, int channel) const
  {
    return this->TheMedium.sigma_a.At(voxel, channel) + this->SigmaS(voxel, channel);
  }
  /// Scattering coefficient of degree l: SigmaS(voxel, channel) times the phase function's moment l. 0 above the
  /// voxel's degree.
  float SigmaS(std::size_t voxel, int channel, int l) const;
  /// Fraction of the scattered light that is treated as unscattered; 0 in voxels that do not scatter.
  float StraightOn(std::size_t voxel, int channel) const;
  /// Truncated phase function of the voxels of highest degree, in the first channel; only if g does not vary.
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
  /// Truncated phase functions by [channel][degree]; used if g does not vary by voxel.
  std::array<std::vector<DeltaM>, 3> OfChannel;
  /// Truncated phase functions by [g, evenly spaced from -1 to 1][degree]; used if g varies.
  std::vector<std::vector<DeltaM>> OfG;
  /// Degree of the angular moments of each voxel, [voxel][channel]; empty: all 0.
  std::vector<std::uint8_t> Degrees;
};

/// A medium's coefficients on the device, 1/length, in the layout of VolumeLayout. sigma_t and sigma_s exclude light
/// that is treated as unscattered (TruncatedScattering.h).
class MediumOnDevice
{
public:
  /// Coefficients for which arrays are allocated, besides sigma_t.
  struct Needs
  {
    bool sigma_s; ///< false: sigma_s is never read, or equals sigma_t
    bool sigma_a;
  };
  MediumOnDevice(Device& device, const Medium& medium, const TruncatedScattering& scattering,
    const VolumeLayout& layout, const Needs& needs);

  const Buffer<float>& SigmaT() const { return this->Extinction; }
  const Buffer<float>& SigmaS() const { return this->Scattering.Size() > 0 ? this->Scattering : this->Extinction; }
  const Buffer<float>& SigmaA() const { return this->Absorption; } ///< sigma_a; empty if not requested
  /// sigma_s of each degree (TruncatedScattering.h), [degree][channel][voxel]; empty if all scattering is isotropic.
  const Buffer<float>& SigmaOfDegrees() const { return this->OfDegrees; }
  /// Transport extinction sigma_a + sigma_s (1 - g), used by the diffusion correction. Equal to SigmaT() if all
  /// scattering is isotropic.
  const Buffer<float>& TransportSigmaT() const
  {
    return this->Transport.Size() > 0 ? this->Transport : this->Extinction;
  }

private:
  Buffer<float> Extinction, Scattering, Absorption, OfDegrees, Transport;
};
}
