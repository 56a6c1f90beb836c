#pragma once

#include "LightPropagation/CoarseDiffusion/CoarseDiffusion.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/TransportParts.h"

#include <array>

namespace tyndall
{
/// Correction step of coarse-mesh DSA (CoarseDiffusion.h). For each channel,
/// diffusion on coarse cells of several voxels predicts the sum of all orders to come; this class also accounts for its
/// power. Construct and call collectively.
class OrdersByCells
{
public:
  /// @param parts  must outlive this
  explicit OrdersByCells(TransportParts& parts);

  /// Powers by channel, W.
  struct Powers
  {
    Rgb scattered = {}; ///< power of the next source
    Rgb magnitude = {}; ///< the same with absolute values
    Rgb left = {};      ///< not accounted for by the coarse solution
  };

  /// Converts the path integrals of a sweep to fluence and to the next source, including the predicted sum of all
  /// orders to come.
  /// @param ledger  receives the absorbed power, and minus the power that the last sweep let escape in excess
  /// @param onTheWay  W that wrapped around periodic axes at the end of the sweep, or that no sweep carries on
  /// @param guess  replaces the coarse solution; null: solve
  Powers ScatterOrder(EnergyLedger& ledger, const Rgb& onTheWay, const Buffer<float>* guess);

  /// Whether all axes are periodic. Power that wraps around can then only be absorbed, so the coarse solution includes
  /// it.
  bool ForeseeWay() const { return this->Closed; }

  /// Copy of the ledger plus the escaped power of all orders to come.
  EnergyLedger WithOut(const EnergyLedger& ledger) const;

private:
  TransportParts& Parts;
  bool Closed; ///< all axes are periodic
  CoarseDiffusion Cells;
  std::array<Rgb, 6> Kept = {}; ///< W by face that the next sweep lets escape in excess
  std::array<Rgb, 6> Out = {};  ///< W by face that escapes in all orders to come
};
}
