#pragma once

#include "LightPropagation/Conservative/TransportParts.h"
#include "LightPropagation/Sweep/SweepOperator.h"

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace tyndall
{
/// Whether it saves time to sweep orders after the first only in the bounding box `filled` of the medium, and the empty
/// voxels around it in one additional sweep. True if the medium leaves much of the grid empty and several orders
/// follow. False if leaveOut is off, or with periodic axes, around which light returns.
bool PaysToOmitEmptySlabs(const VoxelBox& filled, const Grid& grid, const PropagationSettings& settings);

/// Sweeps of source iteration, one per scattering order. An order sweeps all rays through the whole grid, with two
/// exceptions: the first order omits directions without incident light, and later orders omit the empty voxels around
/// the medium. One final sweep computes the light of all later orders in these voxels. Construct and call collectively.
class OrderSweeps
{
public:
  /// @param parts  must outlive this object, as must the arrays of `deposit` and `octantSource`
  /// @param octantSource  sources by octant of directions (OctantSources); null: none
  /// @param byCells  whether the solve uses coarse-mesh DSA
  /// @param shines  whether the source of the first order is non-zero
  OrderSweeps(
    TransportParts& parts, const Deposit& deposit, const Buffer<float>* octantSource, bool byCells, bool shines);

  SweepOperator& Of(int order);
  void EndFirstOrder() { this->Lit.reset(); } ///< releases the sweep of the first order
  /// Whether the sweep of an order omits the empty voxels around the medium; the faces through which its light escapes
  /// are then known only after SweepEmptySlabs().
  bool OmitsEmptySlabs(int order) const { return this->Filled && order > 0; }
  /// Index range [begin, end) of a channel in arrays over voxels that the sweep of an order may change, rounded to
  /// whole vectors.
  std::array<std::size_t, 2> Values(int order) const;
  /// Final sweep, if empty voxels were omitted: computes the light of all orders after the first in the empty voxels
  /// around the medium, and its escaped power by face.
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
  /// Sweep of the later orders through the bounding box of the medium only, if the medium leaves much of the volume
  /// empty; else null.
  std::unique_ptr<SweepOperator> Filled;
  double LitPart = 1.0;   ///< fraction of the rays that the first order sweeps
  double EmptyPart = 0.0; ///< fraction of the voxels of which no angular moments are computed
};
}
