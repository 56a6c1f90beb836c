// Rate of exponential decay of light in a layer, from the mean depth at which it is lost.

#pragma once

// Returns b tau for a layer of optical thickness tau in which light is lost as exp(-b t) at optical depth t. The
// argument is r = 1 - 2 <t> / tau, 0 <= r < 1; <t> is the mean optical depth at which light is lost. Inverts Langevin's
// function, coth(x) - 1 / x = r with x = b tau / 2, to 0.2% (Petrosyan 2017).
static float fall_of(float r)
{
  return 2.0f * (3.0f * r + 0.2f * r * r * sin(3.5f * r) + r * r * r / (1.0f - r));
}
