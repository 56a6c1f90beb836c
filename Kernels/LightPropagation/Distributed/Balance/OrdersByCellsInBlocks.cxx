#include "LightPropagation/Distributed/Balance/OrdersByCellsInBlocks.h"

namespace tyndall
{
OrdersByCellsInBlocks::OrdersByCellsInBlocks(BlockOnDevice& block, const std::array<int, 3>& halvings)
  : Block(block)
{
  for (int c = 0; c < block.Layout.channels; ++c)
  {
    this->Cells.push_back(std::make_unique<CellsOverRanks>(block.TheDevice, block.Comm, block.Partition, block.Layout,
      c, block.OnDevice, halvings, block.Settings.source != PropagationSource::Constant));
  }
}

OrdersByCellsInBlocks::Powers OrdersByCellsInBlocks::ScatterOrder(EnergyLedger& ledger, const Buffer<float>* guess)
{
  Powers all;
  for (std::size_t i = 0; i < this->Cells.size(); ++i)
  {
    const auto c = static_cast<int>(i);
    const CellsOverRanks::Powers powers =
      this->Cells[i]->ScatterOrder(this->Block.Path, this->Block.Fluence, this->Block.Source, guess);
    ledger.Absorb(c, powers.absorbed);
    ledger.SetUnaccounted(c, powers.left);
    all.scattered[c] = powers.scattered;
    all.magnitude[c] = powers.magnitude;
    for (int face = 0; face < 6; ++face)
    {
      ledger.Escape(c, face, -this->Kept[face][c]); // that the sweep just done let out
      this->Kept[face][c] = powers.kept[face];
      this->Out[face][c] = powers.out[face];
    }
  }
  return all;
}

EnergyLedger OrdersByCellsInBlocks::WithOut(const EnergyLedger& ledger) const
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
