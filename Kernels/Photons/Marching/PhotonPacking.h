#pragma once

#include "Device/OpenCL.h"
#include "Distribution/Domain.h"
#include "Medium/VoxelBox.h"
#include "Photons/Photons.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// Photons in the format of the kernels. Positions are in voxels, inside the volume or where the photon enters it. The
/// photons are sorted so that neighbours in space are neighbours in memory.
struct PackedPhotons
{
  int channels = 1; ///< power channels per photon: 1 if one channel suffices for photons of one colour, else 3
  bool grey = true; ///< whether the powers of all photons are grey
  /// Colour of the single channel, with mean 1; (1, 1, 1) for white photons and for three channels.
  Rgb colour = { 1.0, 1.0, 1.0 };
  double unit = 1.0;                ///< W per unit of the packed powers, a power of two
  std::vector<float> values;        ///< of each photon: position (voxels), unit direction, `channels` of power (units)
  std::vector<std::size_t> numbers; ///< index of each photon among the photons given to Pack
  std::vector<int> batchBegin;      ///< index of the first photon of each batch, and one past the last photon
  Rgb entered = {};                 ///< W, power of the photons that enter the volume, by channel
  std::array<std::int64_t, 3> enteredUnits = {}; ///< the power `entered` in whole units
  std::size_t missed = 0;                        ///< number of photons whose lines miss the grid

  std::size_t Count() const { return this->numbers.size(); }
  int FloatsEach() const { return 6 + this->channels; } ///< number of floats per photon in `values`
  int Batches() const { return static_cast<int>(this->batchBegin.size()) - 1; }
};

/// Indices of a subset of all photons.
using PhotonNumbers = std::vector<std::size_t>;

/// Number of batches: the largest Photon::batch plus one.
int BatchesOf(const std::vector<Photon>& photons);

/// Packs photons as a single batch.
/// @param coloured       whether to keep three channels even if one would suffice
/// @param depositsAtMost  maximum number of deposits of one photon: the unit of power is chosen so that no sum of
///   that many deposits of all photons can exceed 2^62 (numerics.md, Eq. (99))
/// @throws InvalidInput if a photon's position, direction, power or weight is not finite, its direction zero, or its
///   power or weight negative
PackedPhotons Pack(const std::vector<Photon>& photons, const Grid& grid, bool coloured, double depositsAtMost);

/// Extracts one channel of packed photons, as photons of one channel.
/// @param channel  index of the packed channel
/// @param colour   power in the requested channel per unit of packed power
/// @param larger   ratio of the new unit to the old one, a power of two, for a channel that carries all of the power. A
///   fainter channel has a smaller unit
PackedPhotons OneChannel(const PackedPhotons& packed, int channel, double colour, double larger);

/// Rounds power to whole units: sums of whole units do not depend on the order of their terms.
inline std::int64_t WholeUnits(float power)
{
  return static_cast<std::int64_t>(static_cast<double>(power) + 0.5);
}

/// Moves a position along its line to the point where it enters the grid; leaves it unchanged if it is inside.
/// @param position, direction  in voxels
/// @return false if the line does not meet the grid
bool MoveOnto(const Grid& grid, std::array<double, 3>& position, const std::array<double, 3>& direction);

// The following functions are for photons distributed over ranks. All photons are numbered rank by rank, first those of
// rank 0, then those of rank 1. The functions are collective, except for ThoseIn.

/// Position of this rank's photons in the numbering of all photons.
struct PlaceOfShare
{
  std::size_t first = 0; ///< index of the rank's first photon among all photons
  std::size_t all = 0;   ///< number of photons of all ranks
};
PlaceOfShare PlaceAmong(Communicator& communicator, std::size_t share);

/// Sums integers over all ranks, without rounding.
std::vector<std::int64_t> SumExactly(Communicator& communicator, const std::vector<std::int64_t>& numbers);

/// Photons that start in this rank's block.
struct StartingPhotons
{
  /// Packed photons that start on this rank. `packed.numbers` holds indices among the photons of all ranks.
  /// `packed.entered` (power that enters the volume) and `packed.missed` (number of photons that miss it) are totals
  /// over all ranks.
  PackedPhotons packed;
  /// Mark of each photon: the integer that it adds to each voxel that it crosses. The upper bits are a count of 1, the
  /// lower bits the photon's weight in units of weightUnit. Empty if photons are not counted.
  std::vector<cl_ulong> marks;
  /// Photon weight that counts as 1 in the integer sums of weights of the voxels; 0 if photons are not counted.
  float weightUnit = 0.0f;
};

/// Packs the photons of all ranks as in a serial run, and sends each to the rank in whose block it starts.
/// @param share    this rank's photons
/// @param numbers  index of each photon of `share` among all photons
/// @param coloured  whether to keep three channels even if one would suffice
/// @param depositsAtMost  maximum number of deposits of one photon, which determines the fixed-point unit of power
///   (Pack)
/// @param settings  whether batches are summed separately, and whether photons are counted
/// @throws InvalidInput  on every rank, if any rank has a photon that Pack refuses or, if batches are requested, whose
///   batch is not 0 to 63, or if photons are counted and exceed the maximum of a voxel's counter
StartingPhotons SendToTheirBlocks(const Domain& domain, const std::vector<Photon>& share, const PhotonNumbers& numbers,
  bool coloured, double depositsAtMost, const MarchSettings& settings);

/// Gives every rank those photons of all ranks that have the given indices, in ascending order of indices.
/// @param chosen  indices among all photons, ascending
std::vector<Photon> ChosenOnEachRank(Communicator& communicator, const std::vector<Photon>& share,
  const PlaceOfShare& place, const std::vector<std::size_t>& chosen);

/// Selects the packed photons that start in a block. A photon belongs to the voxel to which the kernels, with their
/// rounding, assign its position. `entered` and `missed` of the result are still totals over all photons.
PackedPhotons ThoseIn(const VoxelBox& block, const Grid& whole, const PackedPhotons& packed);
}
