#pragma once

namespace tyndall
{
/// Trade-off between accuracy and run time: one choice for the settings that determine both. Each solver has a function
/// that maps it to its own settings, depending on the scene.
enum class Quality
{
  Draft = 0,   ///< for previews while settings are chosen
  Default = 1, ///< the settings' default values
  Fine = 2,
  Reference = 3 ///< for references in comparisons
};

/// Sets `number` to the quality's value if it still has its default value; any other value was chosen by the user and
/// stays. Quality::Default changes no number, so every value can be chosen.
template <class Number>
void SetUnlessChosen(Number& number, const Number& byDefault, const Number& ofQuality)
{
  if (number == byDefault)
  {
    number = ofQuality;
  }
}
}
