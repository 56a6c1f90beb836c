#pragma once

#include "Light/KeptLight.h"
#include "LightPropagation/Published/PublishedFaces.h"
#include "LightPropagation/Published/PublishedModel.h"
#include "LightPropagation/Published/PublishedVolumes.h"

#include <vector>

namespace tyndall
{
/// The scattered light of the last solve as the first guess of this one, of light propagation maps as published
/// (numerics.md, section 6.4): in the moments of PublishedVolumes, of which the first order's are what comes in and
/// what is guessed, and the second's what was found less the guess; and likewise in what leaves through faces that give
/// it back. Kept light is the moments, and behind them W by cell.
class PublishedWarmStart
{
public:
  /// @param kept  null: nothing is begun from or kept; must stay
  PublishedWarmStart(
    const Medium& medium, const PublishedModel& model, const PropagationSettings& settings, const KeptLight* kept);

  bool Keeps() const { return this->Kept != nullptr; }
  bool Begins() const { return this->Keeps() && this->WhyNot.empty(); }
  std::string Words() const { return WordsOfWarmStart(this->WhyNot); }
  const Rgb& Rate() const { return this->Kept->rate; }

  /// Adds the guess, where there is one, to the moments of the first order; their sources are to be made anew.
  /// @param direct  unscattered fluence, channels interleaved
  void AddTo(PublishedVolumes& volumes, PublishedFaces& faces, const std::vector<float>& direct);
  /// Takes it from those that the second found.
  void TakeFrom(PublishedVolumes& volumes);
  KeptLight Leave(const PublishedVolumes& volumes, const PublishedFaces& faces, const Rgb& rate) const;

private:
  std::vector<float> GuessOf(std::size_t first, std::size_t count, std::size_t perChannel) const;
  void Add(Buffer<float>& moments, float sign) const;

  const Medium& TheMedium;
  int Channels;
  bool Counted; ///< orders are, and do not tell how fast they fall
  const KeptLight* Kept;
  LightKind Kind;
  std::string WhyNot;
  std::vector<float> Direct, Guess;
  Rgb First = {};
};
}
