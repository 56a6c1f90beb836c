#include "DiscreteOrdinates/OrdinatesWarmStart.h"

#include "DiscreteOrdinates/OrdinatesParts.h"
#include "DiscreteOrdinates/SweptOrders.h"
#include "Distribution/KeptInBlocks.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
namespace
{
constexpr double SlowestRate = 1.0 - 1e-6; ///< of orders, that is told the next solve
}

OrdinatesGuess OrdinatesWarmStart::Begin(
  int channel, LightKind kind, const OrdinatesAngles& angles, const OrdinatesRanks* ranks)
{
  if (!this->Kept)
  {
    return {};
  }
  if (channel == 0)
  {
    kind.method = "discrete ordinates";
    kind.degree = angles.phase.Terms();
    kind.directions = angles.phase.DirectionCount();
    this->Left.kind = std::move(kind);
  }
  std::string why = this->WhyNotOf(angles);
  OrdinatesGuess guess;
  if (!ranks)
  {
    guess = this->GuessOf(channel, why.empty());
  }
  else
  {
    why = WhyNotBegunOnAny(ranks->others, *this->Kept, why);
    ranks->others.Collective([&] { guess = this->GuessOf(channel, why.empty()); });
  }
  this->WhyNot = this->WhyNot.empty() ? why : this->WhyNot;
  return guess;
}

std::string OrdinatesWarmStart::WhyNotOf(const OrdinatesAngles& angles) const
{
  if (IsPublished(this->Settings))
  {
    return NotBegunAsPublished;
  }
  if (!CanBeginWarm(angles, this->Settings))
  {
    return "sources that terms of the phase function make negative are set to 0 order by order, from darkness on";
  }
  return WhyNotBegun(*this->Kept, this->Left.kind, this->Settings.maximumOrders);
}

/// One channel's part of kept light.
OrdinatesGuess OrdinatesWarmStart::GuessOf(int channel, bool begins) const
{
  OrdinatesGuess guess;
  guess.keeps = true;
  if (begins)
  {
    const std::vector<float>& all = this->Kept->scattered;
    const auto values = static_cast<std::ptrdiff_t>(all.size()) / this->Left.kind.channels;
    guess.values.assign(all.begin() + channel * values, all.begin() + (channel + 1) * values);
    guess.firstScattered = this->Kept->firstScattered[channel];
    guess.rate = this->Kept->rate[channel];
  }
  return guess;
}

void OrdinatesWarmStart::Take(const OrdinatesResult& found, int channel)
{
  this->Left.scattered.insert(this->Left.scattered.end(), found.left.begin(), found.left.end());
  this->Left.firstScattered[channel] = found.firstScattered;
  this->Left.rate[channel] = this->Settings.maximumOrders > 0 ? 0.0 : std::min(found.rate, SlowestRate);
}

void OrdinatesWarmStart::Finish(LightField& light, KeptLight* kept)
{
  if (!kept)
  {
    return;
  }
  this->Left.fromDarkness = kept->fromDarkness;
  light.leftOut.push_back(WordsOfWarmStart(this->WhyNot));
  Keep(std::move(this->Left), this->WhyNot.empty(), light, *kept);
}
}
