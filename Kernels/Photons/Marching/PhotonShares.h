#pragma once

#include "Distribution/Domain.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Marching/PhotonPacking.h"

#include <vector>

namespace tyndall
{
// Photons of which each rank has a share: all of them are those of rank 0, then those of rank 1, and so on. These
// functions are collective but for ThoseIn.

/// Where a rank's share is among all.
struct PlaceOfShare
{
  std::size_t first = 0; ///< number of its first photon
  std::size_t all = 0;   ///< photons of all ranks
};
PlaceOfShare PlaceAmong(Communicator& communicator, std::size_t share);

/// Whole numbers of all ranks, added up without rounding.
std::vector<std::int64_t> SumExactly(Communicator& communicator, const std::vector<std::int64_t>& numbers);

/// Photons that set off in a rank's block.
struct StartingPhotons
{
  PackedPhotons packed;        ///< numbers are those among all; `entered` and `missed` are of all
  std::vector<cl_ulong> marks; ///< of each, where they count (CountedPhotons)
  float weightUnit = 0.0f;
};

/// Packs photons of all shares as one rank would, and sends each to the rank in whose block it sets off.
/// @param share    this rank's photons
/// @param numbers  of these among all
/// @throws InvalidInput  on each, where one of them has a photon that Pack refuses
StartingPhotons SendToTheirBlocks(const Domain& domain, const std::vector<Photon>& share, const PhotonNumbers& numbers,
  const MarchTraits& traits, const MarchSettings& settings);

/// Those with these numbers, ascending, on each rank.
/// @param chosen  fewer than all
std::vector<Photon> ChosenOnEachRank(Communicator& communicator, const std::vector<Photon>& share,
  const PlaceOfShare& place, const std::vector<std::size_t>& chosen);

/// Of packed photons those that set off in a block, by the voxel that kernels take them to be in; with `entered` and
/// `missed` of all.
PackedPhotons ThoseIn(const VoxelBox& block, const Grid& whole, const PackedPhotons& packed);
}
