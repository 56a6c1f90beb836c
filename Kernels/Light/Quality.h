#pragma once

namespace tyndall
{
/// How exact a result is to be, over how long it takes: one word for the numbers that set both. Every solver says in a
/// function of its own which numbers that are, from what the scene is like.
enum class Quality
{
  Draft = 0,   ///< to look at while settings are chosen
  Default = 1, ///< the numbers as they stand
  Fine = 2,
  Reference = 3 ///< to compare others with
};

/// A number is as the quality has it where nobody set it: where it still has its default value. Any other value was
/// chosen and stays. With Quality::Default every number is taken as it stands, so no choice is out of reach.
template <class Number>
void SetUnlessChosen(Number& number, const Number& byDefault, const Number& ofQuality)
{
  if (number == byDefault)
  {
    number = ofQuality;
  }
}
}
