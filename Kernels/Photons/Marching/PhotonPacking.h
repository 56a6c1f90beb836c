#pragma once

#include "Medium/Grid.h"
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
  std::size_t LargestBatch() const; ///< number of photons
};

/// Indices of a subset of all photons.
using PhotonNumbers = std::vector<std::size_t>;

/// The largest batch of any photon, plus one.
int BatchesOf(const std::vector<Photon>& photons);

/// @param coloured       keep three channels even if one would do
/// @param depositsAtMost  maximum deposits of one photon: power is scaled so that no sum of that many deposits can
///   exceed 2^62 (numerics.md, Eq. (99))
/// @param batches        keep the photons of each batch together; otherwise all count as one batch
/// @throws InvalidInput if a photon's position, direction, power or weight is not finite, its direction zero, its power
///   or weight negative, or its batch (if asked for) not 0 to 63
PackedPhotons Pack(
  const std::vector<Photon>& photons, const Grid& grid, bool coloured, double depositsAtMost, bool batches = false);

// The steps of Pack, for photons that are distributed over several ranks.

/// The properties of all photons together that decide how each is packed.
struct PhotonTotals
{
  double brightest = 0.0;      ///< W, of the brightest photon: BrightestOf
  std::int64_t powerUnits = 0; ///< sum of PowerUnitsOf over all photons
  Rgb firstColour = {};        ///< of the first photon that has any power
  bool oneColour = true;       ///< whether all photons have that colour
  int batches = 1;             ///< number of batches that are kept apart
};
double BrightestOf(const std::vector<Photon>& photons); ///< W, channels summed
/// Total power of the photons, each rounded up to units of at most 2^-30 of the brightest of all photons.
std::int64_t PowerUnitsOf(const std::vector<Photon>& photons, double brightest);
Rgb FirstColourOf(const std::vector<Photon>& photons); ///< black if no photon has power
bool HaveColour(const std::vector<Photon>& photons, const Rgb& first);
/// @throws InvalidInput as Pack
void CheckPhotons(const std::vector<Photon>& photons, bool batches);

/// A packing without photons.
PackedPhotons PackingOf(const PhotonTotals& all, bool coloured, double depositsAtMost);
/// Adds photons to a packing made by PackingOf.
void FillPacking(PackedPhotons& packed, const std::vector<Photon>& photons, const Grid& grid);

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
}
