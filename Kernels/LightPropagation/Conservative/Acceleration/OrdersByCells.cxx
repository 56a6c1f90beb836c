#include "LightPropagation/Conservative/Acceleration/OrdersByCells.h"

#include "LightPropagation/Problem/ScatteringOrders.h"

namespace tyndall
{
OrdersByCells::OrdersByCells(TransportParts& parts)
  : Parts(parts)
  , Closed(parts.Problem.Settings().periodic == std::array<bool, 3>{ true, true, true })
{
  const Domain& domain = parts.TheDomain();
  const std::array<int, 3> halvings = CellHalvings(parts.Problem);
  const bool linear = parts.Problem.HasLinearSource();
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    if (domain.IsSerial())
    {
      this->Cells.push_back(std::make_unique<CoarseDiffusion>(
        parts.TheDevice, parts.Layout, c, parts.OnDevice, parts.Problem.Settings().periodic, halvings, linear));
    }
    else
    {
      this->CellsOfRanks.push_back(std::make_unique<CellsOverRanks>(
        parts.TheDevice, domain.Comm(), domain.Partition(), parts.Layout, c, parts.OnDevice, halvings, linear));
    }
  }
}

OrdersByCells::Powers OrdersByCells::ScatterOrder(EnergyLedger& ledger, const Rgb& onTheWay, const Buffer<float>* guess)
{
  Powers all;
  TransportParts& parts = this->Parts;
  for (int c = 0; c < parts.Layout.channels; ++c)
  {
    const CoarseDiffusion::Powers powers = this->Cells.empty()
      ? this->CellsOfRanks[c]->ScatterOrder(parts.Path, parts.Fluence, parts.Source, guess)
      : this->Cells[c]->ScatterOrder(parts.Path, parts.Fluence, parts.Source, this->Closed ? onTheWay[c] : 0.0, guess);
    ledger.Absorb(c, powers.absorbed);
    all.scattered[c] = powers.scattered;
    all.magnitude[c] = powers.magnitude;
    all.left[c] = powers.left;
    for (int face = 0; face < 6; ++face)
    {
      ledger.Escape(c, face, -this->Kept[face][c]); // excess of the sweep just done
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
