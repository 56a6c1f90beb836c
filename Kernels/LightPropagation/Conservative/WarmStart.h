#pragma once

#include "Light/KeptLight.h"
#include "LightPropagation/Conservative/TransportParts.h"

#include <string>
#include <vector>

namespace tyndall
{
/// First guess of a solve: zero, or the scattered light of the previous solve (numerics.md, section 6.4). Uncollided
/// light is always computed anew. A guess changes the number of sweeps, not the limit: the iteration continues from the
/// measured error of the guess.
/// Construct and call collectively; each rank keeps the light of its block.
class WarmStart
{
public:
  /// @param parts  must outlive this
  /// @param kept  must outlive this; null, on all ranks: start from zero and keep nothing
  /// @param method  name of the iteration scheme
  WarmStart(const TransportParts& parts, const KeptLight* kept, const char* method);

  bool Keeps() const { return this->Kept != nullptr; } ///< keep the light of this solve
  /// Whether this solve begins from kept light; the same on all ranks.
  bool Begins() const { return this->Keeps() && this->WhyNot.empty(); }
  std::vector<std::string> LeftOut() const;

  /// Scales the kept light by the change in first-scattered power since the previous solve. Required if Keeps().
  /// @param direct  uncollided fluence, W / length^2, [channel][stride]
  void Prepare(const std::vector<float>& direct);
  /// The first guess, W length, [function][channel][stride].
  const Buffer<float>& Guess() const { return this->Path; }
  const std::vector<float>& Guessed() const { return this->Scaled; } ///< the same on the host
  /// Power that the guess scatters, W, summed over ranks.
  const Rgb& GuessedPower() const { return this->Power; }
  /// Ratio of the last two iterations of the previous solve; 0: not known, because the channel was dark.
  double Rate(int channel) const { return this->Kept->rate[channel]; }

  /// Adds the scattering source of the guess to `source`; TakeGuessFrom subtracts it again.
  void AddGuessTo(const Buffer<float>& source) const;
  void TakeGuessFrom(const Buffer<float>& source);
  /// Magnitude of a source that may be negative, W by channel: root mean square over directions, summed over voxels.
  Rgb MagnitudeOf(const Buffer<float>& source) const;

  /// Light to keep for the next solve.
  /// @param base  fluence that the next solve finds without a guess; the guess is the total fluence minus this
  /// @param moments  higher angular moments minus theirs, in the layout of Guess(); the first function is not read.
  ///   Empty: none
  /// @param rate  ratio of the last two iterations
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
