#pragma once

#include "LightPropagation/CoarseDiffusion/CoarseDiffusion.h"
#include "LightPropagation/Conservative/EnergyLedger.h"
#include "LightPropagation/Conservative/TransportParts.h"

#include <array>

namespace tyndall
{
/// Correction step of coarse-mesh DSA: for each channel, diffusion on coarse cells of several voxels
/// (CoarseDiffusion.h) predicts the sum of all later scattering orders. This class also keeps the energy balance of
/// that prediction. Construct and call collectively.
class OrdersByCells
{
public:
  /// @param parts  must outlive this
  explicit OrdersByCells(TransportParts& parts);

  /// Powers of one scattering order, W by channel.
  struct Powers
  {
    Rgb scattered = {}; ///< power of the next source
    Rgb magnitude = {}; ///< sum of the absolute values of the next source
    Rgb left = {};      ///< power that the coarse solution neither absorbs nor lets escape
  };

  /// Adds the path integrals of the last sweep, and the predicted sum of all later orders, to the fluence, and computes
  /// the next source.
  /// @param ledger  receives the absorbed power, and a correction of the escaped power, which the last sweep
  ///   overestimated
  /// @param onTheWay  power of rays that still wrap around periodic axes after the sweep, W by channel, including rays
  ///   that no later sweep continues
  /// @param guess  path integrals of all later orders, W length, used instead of the coarse solution; null: solve
  Powers ScatterOrder(EnergyLedger& ledger, const Rgb& onTheWay, const Buffer<float>* guess);

  /// Whether the coarse solution includes the power of rays that still wrap around periodic axes. True if all axes are
  /// periodic, because this power then cannot escape.
  bool ForeseeWay() const { return this->Closed; }

  /// Copy of `ledger` plus the predicted escaped power of all later orders.
  EnergyLedger WithOut(const EnergyLedger& ledger) const;

private:
  TransportParts& Parts;
  bool Closed; ///< whether all axes are periodic
  CoarseDiffusion Cells;
  std::array<Rgb, 6> Kept = {}; ///< power by which the next sweep will overestimate the escape through each face, W
  std::array<Rgb, 6> Out = {};  ///< predicted escaped power of all later orders through each face, W
};
}
