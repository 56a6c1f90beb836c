#include "LightPropagation/Conservative/EnergyLedger.h"

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
    double through = 0.0;
    for (const Rgb& face : this->Faces)
    {
      through += face[c];
    }
    for (Rgb& face : this->Faces)
    {
      face[c] *= through > 0.0 ? 1.0 + watts[c] / through : 1.0;
    }
  }
}
}
