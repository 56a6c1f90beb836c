#include "Viewing/Scene/ViewSettings.h"

#include "Numerics/NumberText.h"

namespace tyndall
{
namespace
{
void SetLevel(ViewSettings& settings, double stepSize, int rectangleSamples)
{
  const ViewSettings byDefault;
  SetUnlessChosen(settings.stepSize, byDefault.stepSize, stepSize);
  SetUnlessChosen(settings.rectangleSamples, byDefault.rectangleSamples, rectangleSamples);
}
}

ViewSettings AtQuality(Quality quality, ViewSettings settings)
{
  switch (quality)
  {
    case Quality::Draft: SetLevel(settings, 1.0, 2); break;
    case Quality::Default: break;
    case Quality::Fine: SetLevel(settings, 0.25, 5); break;
    case Quality::Reference: SetLevel(settings, 0.1, 9); break;
  }
  return settings;
}

std::vector<std::string> Words(const ViewSettings& settings)
{
  return { "StepSize = " + Text("%g", settings.stepSize),
    "RectangleSamples = " + std::to_string(settings.rectangleSamples) };
}
}
