#pragma once

#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Distributed/Balance/CellsOverRanks.h"
#include "LightPropagation/Distributed/BlockOnDevice.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// What diffusion on cells of a grid spread over ranks (CellsOverRanks.h) says of all orders to come, for each channel
/// of a solve, and how its power is counted: as OrdersByCells of the whole.
class OrdersByCellsInBlocks
{
public:
  /// All ranks make one together.
  /// @param block  must stay
  /// @param halvings  as CellsOverRanks has them
  OrdersByCellsInBlocks(BlockOnDevice& block, const std::array<int, 3>& halvings);

  /// W, of all ranks.
  struct Powers
  {
    Rgb scattered = {}; ///< the next source
    Rgb magnitude = {}; ///< the same without signs
  };

  /// From the path integrals of a sweep to fluence and the next source, with all orders to come. All ranks call it.
  /// @param ledger  what is absorbed and left over is counted here, and that the sweep let out too much
  /// @param guess  of all orders to come, in the place of the cells' solution; null, on all ranks: that
  Powers ScatterOrder(EnergyLedger& ledger, const Buffer<float>* guess);

  /// A ledger with what leaves of the orders to come.
  EnergyLedger WithOut(const EnergyLedger& ledger) const;

private:
  BlockOnDevice& Block;
  std::vector<std::unique_ptr<CellsOverRanks>> Cells; ///< by channel
  std::array<Rgb, 6> Kept = {};                       ///< W, through faces, that the next sweep is to let out less
  std::array<Rgb, 6> Out = {};                        ///< W, through faces, of all orders to come
};
}
