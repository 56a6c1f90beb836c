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
/// Photons in the kernels' format: positions in voxels, in the volume or where they enter it, sorted so that neighbours
/// in space are neighbours in memory.
struct PackedPhotons
{
  int channels = 1;                 ///< 1 if all photons have the same colour and one channel suffices, else 3
  bool grey = true;                 ///< whether all photons are grey
  Rgb colour = { 1.0, 1.0, 1.0 };   ///< colour of the single channel; white: (1, 1, 1)
  double unit = 1.0;                ///< W of one unit of power, a power of two
  std::vector<float> values;        ///< position (voxels), unit direction, `channels` of power (units) of each photon
  std::vector<std::size_t> numbers; ///< index of each among the photons that were packed
  std::vector<int> batchBegin;      ///< index of the first photon of each batch, and one past the last photon
  Rgb entered = {};                 ///< W, by channel
  std::array<std::int64_t, 3> enteredUnits = {}; ///< the same in units, whole numbers
  std::size_t missed = 0;                        ///< number of photons that do not meet the volume

  std::size_t Count() const { return this->numbers.size(); }
  int FloatsEach() const { return 6 + this->channels; }
  int Batches() const { return static_cast<int>(this->batchBegin.size()) - 1; }
};

/// Indices of a subset of all photons.
using PhotonNumbers = std::vector<std::size_t>;

/// The largest batch of any photon, plus one.
int BatchesOf(const std::vector<Photon>& photons);

/// Packs photons, all as one batch.
/// @param coloured       keep three channels even if one would do
/// @param depositsAtMost  maximum deposits of one photon: power is scaled so that no sum of that many deposits can
///   exceed 2^62 (numerics.md, Eq. (99))
/// @throws InvalidInput if a photon's position, direction, power or weight is not finite, its direction zero, or its
///   power or weight negative
PackedPhotons Pack(const std::vector<Photon>& photons, const Grid& grid, bool coloured, double depositsAtMost);

/// Extracts one channel of packed photons.
/// @param channel  which of the packed channels
/// @param colour   power in the wanted channel per unit of packed power
/// @param larger   ratio of the new unit to the old one, a power of two
PackedPhotons OneChannel(const PackedPhotons& packed, int channel, double colour, double larger);

/// Rounds power to whole units, whose sums do not depend on the order of their terms.
inline std::int64_t WholeUnits(float power)
{
  return static_cast<std::int64_t>(static_cast<double>(power) + 0.5);
}

/// Moves a position to where its line enters the grid; leaves it unchanged if it is inside.
/// @param position, direction  in voxels
/// @return false if the line does not meet the grid
bool MoveOnto(const Grid& grid, std::array<double, 3>& position, const std::array<double, 3>& direction);

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
  /// If photons are counted, the mark by which each is counted in the voxels that it crosses (PhotonMarch.cl), and the
  /// photon weight per unit of the voxels' sums.
  std::vector<cl_ulong> marks;
  float weightUnit = 0.0f;
};

/// Packs the photons of all ranks as a serial run would, and sends each to the rank in whose block it starts.
/// @param share    this rank's photons
/// @param numbers  indices of these among all photons
/// @param coloured, depositsAtMost  as for Pack
/// @param settings  whether batches are kept apart, and photons are counted
/// @throws InvalidInput  on every rank, if any of them has a photon that Pack refuses or, if batches are asked for,
///   whose batch is not 0 to 63, or if there are more photons than voxels can count
StartingPhotons SendToTheirBlocks(const Domain& domain, const std::vector<Photon>& share, const PhotonNumbers& numbers,
  bool coloured, double depositsAtMost, const MarchSettings& settings);

/// Gathers the photons with the given indices on each rank, ascending.
/// @param chosen  indices among all photons, fewer than all
std::vector<Photon> ChosenOnEachRank(Communicator& communicator, const std::vector<Photon>& share,
  const PlaceOfShare& place, const std::vector<std::size_t>& chosen);

/// The packed photons that start in a block, judged by the voxel that the kernels assign to them. `entered` and
/// `missed` stay totals.
PackedPhotons ThoseIn(const VoxelBox& block, const Grid& whole, const PackedPhotons& packed);
}
