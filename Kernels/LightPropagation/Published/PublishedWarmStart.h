#pragma once

#include "Distribution/Communicator.h"
#include "Light/KeptLight.h"
#include "LightPropagation/Published/PublishedFaces.h"
#include "LightPropagation/Published/PublishedModel.h"

#include <functional>
#include <vector>

namespace tyndall
{
/// The scattered light of the last solve as the first guess of this one, of light propagation maps as published
/// (numerics.md, section 6.4): in the moments of which the first order's are what comes in and what is guessed, and the
/// second's what was found less the guess; and likewise in what leaves through faces that give it back. Kept light is
/// the moments, and behind them W by cell.
///
/// Of a grid that is spread over ranks each has one, of its block, and of the cells of all faces: all make it together,
/// and call together what is said below.
class PublishedWarmStart
{
public:
  /// What is solved, of a rank's block where there are several; must stay.
  struct Scene
  {
    const Medium& medium;
    const PublishedModel& model;
    const PropagationSettings& settings;
    const Grid& whole;
    std::size_t perChannel;         ///< of how many values in turn in the moments channels are made
    Communicator* others = nullptr; ///< null: the whole is here
    VoxelBox block = {};            ///< of the whole; without others none
  };

  /// @param kept  null: nothing is begun from or kept; must stay
  PublishedWarmStart(const Scene& scene, const KeptLight* kept);

  bool Keeps() const { return this->Kept != nullptr; }
  /// Whether this solve begins from kept light; all ranks or none.
  bool Begins() const { return this->Keeps() && this->WhyNot.empty(); }
  std::string Words() const { return WordsOfWarmStart(this->WhyNot); }
  const Rgb& Rate() const { return this->Kept->rate; }

  /// Where light is kept: told what the first order found. Adds the guess to it, where there is one. All ranks call it.
  /// @param moments  of that order, those of one layout
  /// @param direct  unscattered fluence, channels interleaved
  void AddTo(std::vector<float>& moments, PublishedFaces& faces, const std::vector<float>& direct);
  /// Takes it from the moments that the second found.
  void TakeFrom(std::vector<float>& moments);
  /// @param totals  moments of all orders
  KeptLight Leave(std::vector<float> totals, const PublishedFaces& faces, const Rgb& rate) const;

private:
  void Collective(const std::function<void()>& work) const;
  void AddGuessTo(std::vector<float>& moments, PublishedFaces& faces);
  std::vector<float> GuessOf(std::size_t first, std::size_t count, std::size_t perChannel) const;

  Scene The;
  const KeptLight* Kept;
  LightKind Kind;
  std::string WhyNot;
  std::vector<float> Direct, Guess;
  Rgb First = {};
};
}
