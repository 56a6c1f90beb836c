#pragma once

#include "Distribution/Domain.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Marching/PhotonPacking.h"

#include <vector>

namespace tyndall
{
// Photons distributed over ranks: rank 0 has the first of all photons, then rank 1, and so on. These functions are
// collective, except for ThoseIn.

/// Position of a rank's photons among all photons.
struct PlaceOfShare
{
  std::size_t first = 0; ///< index of its first photon among all
  std::size_t all = 0;   ///< number of photons of all ranks
};
PlaceOfShare PlaceAmong(Communicator& communicator, std::size_t share);

/// Sums integers over all ranks, without rounding.
std::vector<std::int64_t> SumExactly(Communicator& communicator, const std::vector<std::int64_t>& numbers);

/// Photons that start in a rank's block.
struct StartingPhotons
{
  /// `packed.numbers` are indices among all photons; `entered` and `missed` are totals over all ranks.
  PackedPhotons packed;
  std::vector<cl_ulong> marks; ///< counting mark of each photon, if photons are counted (CountedPhotons)
  float weightUnit = 0.0f;
};

/// Packs the photons of all ranks as a serial run would, and sends each to the rank in whose block it starts.
/// @param share    this rank's photons
/// @param numbers  indices of these among all photons
/// @throws InvalidInput  on every rank, if any of them has a photon that Pack refuses
StartingPhotons SendToTheirBlocks(const Domain& domain, const std::vector<Photon>& share, const PhotonNumbers& numbers,
  const MarchTraits& traits, const MarchSettings& settings);

/// Gathers the photons with the given indices on each rank, ascending.
/// @param chosen  indices among all photons, fewer than all
std::vector<Photon> ChosenOnEachRank(Communicator& communicator, const std::vector<Photon>& share,
  const PlaceOfShare& place, const std::vector<std::size_t>& chosen);

/// The packed photons that start in a block, judged by the voxel that the kernels assign to them. `entered` and
/// `missed` stay totals.
PackedPhotons ThoseIn(const VoxelBox& block, const Grid& whole, const PackedPhotons& packed);
}
