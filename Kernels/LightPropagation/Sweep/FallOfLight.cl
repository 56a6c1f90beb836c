// Rate of exponential decay of light in a layer, from the mean depth at which it is lost.

#pragma once

// Returns b tau for a layer of optical thickness tau in which light is lost as exp(-b t) at optical depth t. The
// argument is 2 <t> / tau, above 0 and at most 1; <t> is the mean optical depth at which light is lost. Inverts
// Langevin's function, coth(x) - 1 / x = r with r = 1 - 2 <t> / tau and x = b tau / 2, to 0.2% (Petrosyan 2017).
static float fall_behind(float depth)
{
  const float r = 1.0f - depth;
  return 2.0f * (3.0f * r + 0.2f * r * r * sin(3.5f * r) + r * r * r / depth);
}
// The same for r as the argument, 0 <= r < 1.
static float fall_of(float r)
{
  return fall_behind(1.0f - r);
}
