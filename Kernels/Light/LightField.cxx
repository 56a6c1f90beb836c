#include "Light/LightField.h"

#include <cmath>

namespace tyndall
{
double EnergyBalance::RelativeError(int channels) const
{
  double worst = 0.0;
  for (int c = 0; c < channels; ++c)
  {
    const double in = this->entered[c] + this->emitted[c];
    const double out = this->absorbed[c] + this->escaped[c] + this->leftOver[c];
    const double error = in > 0.0 ? std::abs(in - out) / in : std::abs(out);
    worst = error <= worst || std::isnan(worst) ? worst : error; // NaN propagates
  }
  return worst;
}
}
