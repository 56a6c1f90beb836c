#pragma once

#include "DiscreteOrdinates/OrdinatesScene.h"
#include "DiscreteOrdinates/OrdinatesSettings.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"

#include <string>

namespace tyndall
{
/// The light of the last solve as the first guess of this one, channel by channel (numerics.md, section 6.4), of the
/// whole or of the block of one rank, where all ranks begin from theirs or none does.
class OrdinatesWarmStart
{
public:
  /// @param kept  null: nothing is begun from or kept; must stay, as settings
  OrdinatesWarmStart(const KeptLight* kept, const OrdinatesSettings& settings)
    : Kept(kept)
    , Settings(settings)
  {
  }

  /// What a channel begins from. All ranks call it.
  /// @param kind  of the solve, but for method, degree and directions, which are of the angles
  /// @param ranks  null: the whole is here
  OrdinatesGuess Begin(int channel, LightKind kind, const OrdinatesAngles& angles, const OrdinatesRanks* ranks);
  /// What it left for the next solve; of one channel after the other.
  void Take(const OrdinatesResult& found, int channel);
  /// Puts what all channels left in the place of what was kept, and says of light how it began. Nothing where nothing
  /// is kept.
  void Finish(LightField& light, KeptLight* kept);

private:
  std::string WhyNotOf(const OrdinatesAngles& angles) const;
  OrdinatesGuess GuessOf(int channel, bool begins) const;

  const KeptLight* Kept;
  const OrdinatesSettings& Settings;
  KeptLight Left;
  std::string WhyNot; ///< of the first channel that has a reason
};
}
