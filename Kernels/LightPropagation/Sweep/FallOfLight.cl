// Decay rate of light that is lost near one side of a layer.

#pragma once

// Returns b tau for a layer of optical depth tau in which light is lost as exp(-b t), given r = 1 - 2 t / tau for its
// mean depth t, 0 <= r < 1: the inverse of Langevin's function coth(x) - 1 / x at x = b tau / 2, to 0.2% (Petrosyan
// 2017).
static float fall_of(float r)
{
  return 2.0f * (3.0f * r + 0.2f * r * r * sin(3.5f * r) + r * r * r / (1.0f - r));
}
