#include "LatticeBoltzmann/LatticeQuality.h"

#include "Numerics/NumberText.h"

namespace tyndall
{
namespace
{
void SetLevel(LatticeSettings& settings, int directions, double tolerance)
{
  const LatticeSettings byDefault;
  SetUnlessChosen(settings.directions, byDefault.directions, directions);
  SetUnlessChosen(settings.tolerance, byDefault.tolerance, tolerance);
}
}

LatticeSettings AtQuality(Quality quality, LatticeSettings settings)
{
  switch (quality)
  {
    case Quality::Draft: SetLevel(settings, 6, 1e-2); break;
    case Quality::Default: break;
    case Quality::Fine: SetLevel(settings, 18, 1e-5); break;
    case Quality::Reference: SetLevel(settings, 18, 1e-6); break;
  }
  return settings;
}

std::vector<std::string> Words(const LatticeSettings& settings)
{
  return { "Lattice = " + std::to_string(settings.directions), "Tolerance = " + Text("%g", settings.tolerance) };
}
}
