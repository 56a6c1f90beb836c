#pragma once

namespace tyndall
{
/// Trade-off between accuracy and run time. Each solver has a function that chooses its settings by a quality,
/// depending on the scene.
enum class Quality
{
  Draft = 0,   ///< previews while settings are chosen
  Default = 1, ///< the settings' default values
  Fine = 2,
  Reference = 3 ///< reference solutions of comparisons
};

/// Sets `number` to the quality's value `ofQuality` if it still has its default value. A number with any other value
/// was chosen by the user and is not changed. Quality::Default changes no number, so that a user can choose any value.
template <class Number>
void SetUnlessChosen(Number& number, const Number& byDefault, const Number& ofQuality)
{
  if (number == byDefault)
  {
    number = ofQuality;
  }
}
}
