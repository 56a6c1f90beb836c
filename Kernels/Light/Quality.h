#pragma once

namespace tyndall
{
/// Trade-off between accuracy and run time, from which the settings that determine both are chosen. Each solver has a
/// function that maps a quality to its settings, depending on the scene.
enum class Quality
{
  Draft = 0,   ///< previews while settings are chosen
  Default = 1, ///< the settings' default values
  Fine = 2,
  Reference = 3 ///< reference solutions of comparisons
};

/// Sets `number` to the quality's value `ofQuality` if it has its default value; any other value was chosen by the user
/// and is not changed. Quality::Default changes no number, so a user can choose any value.
template <class Number>
void SetUnlessChosen(Number& number, const Number& byDefault, const Number& ofQuality)
{
  if (number == byDefault)
  {
    number = ofQuality;
  }
}
}
