#pragma once

#include "Light/KeptLight.h"
#include "LightPropagation/Conservative/TransportParts.h"

#include <string>
#include <vector>

namespace tyndall
{
/// Where a solve begins: in the dark, or at the scattered light of the last one (numerics.md, section 6.4). Unscattered
/// light is found anew in any case. A guess changes how many sweeps there are, not what they lead to: iterations go on
/// from its error, which is measured as anywhere else.
/// Made and called collectively; a rank keeps the light of its block.
class WarmStart
{
public:
  /// @param parts  must stay
  /// @param kept  null, on all ranks: nothing is begun from or kept; must stay
  /// @param method  in words, how orders are added up
  WarmStart(const TransportParts& parts, const KeptLight* kept, const char* method);

  bool Keeps() const { return this->Kept != nullptr; } ///< this solve's light is wanted
  /// Whether this solve begins from kept light; all ranks or none.
  bool Begins() const { return this->Keeps() && this->WhyNot.empty(); }
  std::vector<std::string> LeftOut() const;

  /// To be told where light is kept. Scales kept light by how what is scattered first has changed.
  /// @param direct  unscattered fluence, W / length^2, [channel][stride]
  void Prepare(const std::vector<float>& direct);
  /// Kept light as it is guessed, W length, [function][channel][stride].
  const Buffer<float>& Guess() const { return this->Path; }
  const std::vector<float>& Guessed() const { return this->Scaled; } ///< the same on the host
  /// W that are scattered of it, on all ranks.
  const Rgb& GuessedPower() const { return this->Power; }
  /// By which the last iterations of the last solves fell, each over the one before; 0: not known, it was dark.
  double Rate(int channel) const { return this->Kept->rate[channel]; }

  /// Adds what is scattered of the guess to a source, and takes that away again.
  void AddGuessTo(const Buffer<float>& source) const;
  void TakeGuessFrom(const Buffer<float>& source);
  /// Of a source that can be negative, W by channel: its root mean square over all directions, summed over voxels.
  Rgb MagnitudeOf(const Buffer<float>& source) const;

  /// What is left for the next solve.
  /// @param base  fluence that the next solve finds without a guess; its guess is what all fluence has beyond that
  /// @param moments  what the others have beyond it, as Guess() is; the first function is not read. Empty: none
  /// @param rate  of the last iteration over the one before
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
