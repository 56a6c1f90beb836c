#pragma once

#include "Lights/Lights.h"

#include <vector>

namespace tyndall
{
/// A real medium at density 1, by measured or computed coefficients.
struct MediumPreset
{
  const char* name;
  const char* densityOne; ///< what density 1 means
  Rgb sigma_s;            ///< 1/mm
  Rgb sigma_a;            ///< 1/mm
  Rgb g;                  ///< mean cosine of the phase function; 0 where sigma_s is a reduced one, sigma_s (1 - g)
  const char* source;
};

/// The real media there are. Red, green, blue stand for 650, 550 and 450 nm where the source has wavelengths.
const std::vector<MediumPreset>& MediumPresets();
}
