#pragma once

#include "Lights/Lights.h"

#include <vector>

namespace tyndall
{
/// Measured or computed coefficients of a real medium at density 1.
struct MediumPreset
{
  const char* name;
  const char* densityOne; ///< physical density that has the value 1, as text for users
  Rgb sigma_s;            ///< scattering coefficient, 1/mm
  Rgb sigma_a;            ///< absorption coefficient, 1/mm
  Rgb g; ///< mean cosine of the phase function; 0 if sigma_s is the reduced coefficient, sigma_s (1 - g)
  /// Publication from which the coefficients are taken.
  const char* source;
};

/// All presets. If the source specifies wavelengths, red, green and blue are at 650, 550 and 450 nm.
const std::vector<MediumPreset>& MediumPresets();
}
