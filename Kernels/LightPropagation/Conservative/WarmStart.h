#pragma once

#include "Light/KeptLight.h"
#include "LightPropagation/Conservative/TransportParts.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Initial guess of a solve: zero, or the scattered light of the previous solve (numerics.md, section 6.4). Uncollided
/// light is always computed anew. The guess changes the number of sweeps, not the limit: the iteration continues from
/// the error of the guess, which the first sweep measures. Construct and call collectively; each rank keeps the light
/// of its block.
class WarmStart
{
public:
  /// @param parts  must outlive this
  /// @param kept  light of the previous solve, must outlive this object. Null, which it then is on all ranks: the solve
  ///   starts from zero and keeps no light
  /// @param method  name of the iteration scheme
  WarmStart(const TransportParts& parts, const KeptLight* kept, const char* method);

  bool Keeps() const { return this->Kept != nullptr; } ///< whether the light of this solve is kept for the next
  /// Whether this solve begins from the light of the previous one; equal on all ranks.
  bool Begins() const { return this->Keeps() && this->WhyNot.empty(); }
  std::vector<std::string> LeftOut() const;

  /// Computes the initial guess: the kept light, scaled by the ratio of first-scattered powers of this solve and the
  /// previous one, Eq. (46a). Must be called if Keeps().
  /// @param direct  uncollided fluence, W / length^2, [channel][voxel]
  void Prepare(const std::vector<float>& direct);
  /// Path integrals of the initial guess on the device, W length, [function][channel][voxel].
  const Buffer<float>& Guess() const { return this->Path; }
  const std::vector<float>& Guessed() const { return this->Scaled; } ///< Guess() in host memory
  /// Power scattered from the initial guess, W by channel, summed over ranks.
  const Rgb& GuessedPower() const { return this->Power; }
  /// Ratio of the last two changes of the previous solve's iteration; 0: unknown, because the channel had no light.
  double Rate(int channel) const { return this->Kept->rate[channel]; }

  /// Adds the scattering source of the initial guess to `source`; TakeGuessFrom() subtracts it, and frees the guess.
  void AddGuessTo(const Buffer<float>& source) const;
  void TakeGuessFrom(const Buffer<float>& source);
  /// Magnitude of a source that may be negative, W by channel: root mean square over directions, summed over voxels
  /// (numerics.md, Eq. (46c)).
  /// @param functions  number of angular functions in `source`
  /// @param parts  number of arrays of a channel, each for the same fraction of all directions
  Rgb MagnitudeOf(const Buffer<float>& source, int functions, int parts = 1) const;

  /// Light to keep for the next solve: total fluence minus `base`.
  /// @param base  the part of the fluence that the next solve computes anew, W / length^2, [channel][voxel]
  /// @param moments  higher angular moments minus those of `base`, [function][channel][voxel]; the first function is
  ///   not read. Empty: isotropic
  /// @param rate  ratio of the last two changes of the iteration
  KeptLight Leave(const std::vector<float>& base, const std::vector<float>& moments, const Rgb& rate) const;

private:
  LightKind Kind(const char* method) const;
  Rgb ScatteredOf(const std::vector<float>& values) const;

  const TransportParts& Parts;
  const Domain& TheDomain;
  const VolumeLayout& Layout;
  const KeptLight* Kept;
  LightKind TheKind;
  std::string WhyNot;
  Buffer<float> Path;
  std::vector<float> Scaled;
  Rgb Power = {}, First = {};
};
}
