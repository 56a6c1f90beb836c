#pragma once

#include "LightPropagation/CoarseDiffusion/CellsOverRanks.h"
#include "LightPropagation/CoarseDiffusion/CoarseDiffusion.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/TransportParts.h"

#include <array>
#include <memory>
#include <vector>

namespace tyndall
{
/// The correction of coarse-mesh DSA (CoarseDiffusion.h; over ranks CellsOverRanks.h): what diffusion on cells of
/// voxels finds of all orders to come, for each channel of a solve, and how its power is counted. Made and called
/// collectively.
class OrdersByCells
{
public:
  /// @param parts  must stay
  explicit OrdersByCells(TransportParts& parts);

  /// W.
  struct Powers
  {
    Rgb scattered = {}; ///< the next source
    Rgb magnitude = {}; ///< the same without signs
    Rgb left = {};      ///< that the cells' solution accounts for nowhere
  };

  /// From the path integrals of a sweep to fluence and the next source, with all orders to come.
  /// @param ledger  what is absorbed is counted here, and that the sweep let out too much
  /// @param onTheWay  W, round periodic axes when the sweep ended, or that no sweep goes on with
  /// @param guess  of all orders to come, in the place of the cells' solution; null: that
  Powers ScatterOrder(EnergyLedger& ledger, const Rgb& onTheWay, const Buffer<float>* guess);

  /// Whether all axes are periodic: power on the way can only be absorbed, so the cells' solution includes it.
  bool ForeseeWay() const { return this->Closed; }

  /// A ledger with what leaves of the orders to come.
  EnergyLedger WithOut(const EnergyLedger& ledger) const;

private:
  TransportParts& Parts;
  bool Closed;                                               ///< all axes are periodic
  std::vector<std::unique_ptr<CoarseDiffusion>> Cells;       ///< by channel, of a serial domain
  std::vector<std::unique_ptr<CellsOverRanks>> CellsOfRanks; ///< the same of several ranks
  std::array<Rgb, 6> Kept = {}; ///< W, through faces, that the next sweep is to let out less
  std::array<Rgb, 6> Out = {};  ///< W, through faces, of all orders to come
};
}
