#include "LightPropagation/Conservative/EnergyLedger.h"

#include <algorithm>

namespace tyndall
{
void EnergyLedger::Count(const SweepTally& tally)
{
  for (int c = 0; c < 3; ++c)
  {
    for (int face = 0; face < 6; ++face)
    {
      this->Enter(c, tally.in[face][c]);
      this->Escape(c, face, tally.out[face][c]);
    }
  }
}

void EnergyLedger::SettleOvercount(double error)
{
  for (std::size_t c = 0; c < 3; ++c)
  {
    double &left = this->Sums.leftOver[c], out = this->Sums.absorbed[c] + this->Sums.escaped[c];
    if (left >= 0.0 || -left > error * out)
    {
      continue;
    }
    const double part = 1.0 + left / out;
    this->Sums.absorbed[c] *= part;
    this->Sums.escaped[c] *= part;
    for (Rgb& face : this->Faces)
    {
      face[c] *= part;
    }
    left = 0.0;
  }
}

void EnergyLedger::ShareEscaped(const Rgb& watts)
{
  for (int c = 0; c < 3; ++c)
  {
    double through = watts[c], positive = 0.0;
    for (const Rgb& face : this->Faces)
    {
      through += face[c];
      positive += std::max(face[c], 0.0);
    }
    for (Rgb& face : this->Faces)
    {
      face[c] = positive > 0.0 ? std::max(face[c], 0.0) * std::max(through / positive, 0.0) : 0.0;
    }
    this->Sums.escaped[c] = std::max(this->Sums.escaped[c], 0.0);
  }
}
}
