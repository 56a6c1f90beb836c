#pragma once

#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Sweep/SweepOperator.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace tyndall
{
/// The sweeps of source iteration. Orders sweep all rays through the whole grid, with two exceptions: the first order
/// omits directions without incident light, and later orders omit voxels around the medium, whose light is computed at
/// the end for all orders in one sweep. Construct and call collectively.
class OrderSweeps
{
public:
  /// @param parts  must outlive this, as must what `deposit` and `octantSource` refer to
  /// @param octantSource  sources by octant; null: none
  /// @param byCells  for coarse-mesh DSA
  /// @param shines  the source of the first order is not zero
  OrderSweeps(
    TransportParts& parts, const Deposit& deposit, const Buffer<float>* octantSource, bool byCells, bool shines);

  SweepOperator& Of(int order);
  void EndFirstOrder() { this->Lit.reset(); } ///< releases the sweep that only the first order needs
  /// Whether an order is swept without the voxels around the medium; the faces through which light escapes are then not
  /// known yet.
  bool OmitsEmptySlabs(int order) const { return this->Filled && order > 0; }
  /// Index range of a channel that the sweep of an order may change, in whole vectors.
  std::array<std::size_t, 2> Values(int order) const;
  /// Computes the light of all orders after the first in the voxels around the medium, and through the box faces, if
  /// they were omitted.
  void SweepEmptySlabs(EnergyLedger& ledger, const Monitor& monitor);
  std::vector<std::string> LeftOut() const;

private:
  void MakeLitSweep(const Deposit& deposit);
  bool MayOmitEmptySlabs() const;
  void AddOutside(const VoxelBox& box);

  TransportParts& Parts;
  std::unique_ptr<SweepOperator> Whole;
  /// Sweep of the first order along directions with incident light only, if these are few and the medium does not emit;
  /// else null.
  std::unique_ptr<SweepOperator> Lit;
  /// Sweep of the later orders if the medium leaves much of the volume empty; else null.
  std::unique_ptr<SweepOperator> Filled;
  double LitPart = 1.0; ///< fraction of the rays that the first order sweeps
};
}
