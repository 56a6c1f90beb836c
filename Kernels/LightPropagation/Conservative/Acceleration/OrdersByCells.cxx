#include "LightPropagation/Conservative/Acceleration/OrdersByCells.h"

#include "LightPropagation/Problem/ScatteringOrders.h"

namespace tyndall
{
OrdersByCells::OrdersByCells(TransportParts& parts)
  : Parts(parts)
  , Closed(parts.Problem.Settings().periodic == std::array<bool, 3>{ true, true, true })
  , Cells(parts.TheDevice, parts.TheDomain(), parts.Layout, parts.OnDevice, parts.Path,
      { parts.Problem.Settings().periodic, CellHalvings(parts.Problem), parts.Problem.HasLinearSource() })
{
}

OrdersByCells::Powers OrdersByCells::ScatterOrder(EnergyLedger& ledger, const Rgb& onTheWay, const Buffer<float>* guess)
{
  Powers all;
  const TransportParts& parts = this->Parts;
  const std::vector<CoarseDiffusion::Powers> ofChannels =
    this->Cells.ScatterOrder(parts.Fluence, parts.Source, this->Closed ? onTheWay : Rgb{}, guess);
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    const CoarseDiffusion::Powers& powers = ofChannels[c];
    ledger.Absorb(c, powers.absorbed);
    all.scattered[c] = powers.scattered;
    all.magnitude[c] = powers.magnitude;
    all.left[c] = powers.left;
    for (int face = 0; face < 6; ++face)
    {
      ledger.Escape(c, face, -this->Kept[face][c]); // the last sweep overestimated the escape by Kept
      this->Kept[face][c] = powers.kept[face];
      this->Out[face][c] = powers.out[face];
    }
  }
  return all;
}

EnergyLedger OrdersByCells::WithOut(const EnergyLedger& ledger) const
{
  EnergyLedger with = ledger;
  for (int face = 0; face < 6; ++face)
  {
    for (int c = 0; c < 3; ++c)
    {
      with.Escape(c, face, this->Out[face][c]);
    }
  }
  return with;
}
}
