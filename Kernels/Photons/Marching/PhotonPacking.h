#pragma once

#include "Medium/Grid.h"
#include "Photons/Photons.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// Photons as the kernels read them: in the volume or where they enter it, in voxels, neighbours in space next to each
/// other.
struct PackedPhotons
{
  int channels = 1;                 ///< 1 where all photons have the same colour and one is enough, else 3
  bool grey = true;                 ///< all photons are
  Rgb colour = { 1.0, 1.0, 1.0 };   ///< that the one channel stands for; white: (1, 1, 1)
  double unit = 1.0;                ///< W of one unit of power, a power of two
  std::vector<float> values;        ///< position (voxels), unit direction, `channels` of power (units) of each photon
  std::vector<std::size_t> numbers; ///< which of the photons given it is
  std::vector<int> batchBegin;      ///< place of the first photon of each batch, and beyond the last one
  Rgb entered = {};                 ///< W, by channel
  std::array<std::int64_t, 3> enteredUnits = {}; ///< the same in units
  std::size_t missed = 0;                        ///< photons that do not meet the volume

  std::size_t Count() const { return this->numbers.size(); }
  int FloatsEach() const { return 6 + this->channels; }
  int Batches() const { return static_cast<int>(this->batchBegin.size()) - 1; }
  std::size_t LargestBatch() const; ///< photons
};

/// Which of all photons some are.
using PhotonNumbers = std::vector<std::size_t>;

/// The largest batch that photons are of, and one.
int BatchesOf(const std::vector<Photon>& photons);

/// @param coloured       keep three channels even where one would do
/// @param depositsAtMost  of one photon: power is scaled so that no sum of that many deposits can exceed 2^62
///                        (numerics.md, Eq. (99))
/// @param batches        keep each batch together; else all are of one
/// @throws InvalidInput where a photon's position, direction, power or weight is not finite, its direction zero, its
///   power or weight negative, or its batch (if asked for) not 0 to 63
PackedPhotons Pack(
  const std::vector<Photon>& photons, const Grid& grid, bool coloured, double depositsAtMost, bool batches = false);

// What Pack does, in parts, for photons of which each of several ranks has some.

/// What of all photons decides how each is packed.
struct PhotonTotals
{
  double brightest = 0.0;      ///< W, of any: BrightestOf
  std::int64_t powerUnits = 0; ///< sum of PowerUnitsOf
  Rgb firstColour = {};        ///< of the first one that has any power
  bool oneColour = true;       ///< all have that
  int batches = 1;             ///< that are kept apart
};
double BrightestOf(const std::vector<Photon>& photons); ///< W, channels summed
/// Their power, rounded up to units of at most 2^-30 of the brightest of all.
std::int64_t PowerUnitsOf(const std::vector<Photon>& photons, double brightest);
Rgb FirstColourOf(const std::vector<Photon>& photons); ///< black: none has power
bool HaveColour(const std::vector<Photon>& photons, const Rgb& first);
/// @throws InvalidInput as Pack
void CheckPhotons(const std::vector<Photon>& photons, bool batches);

PackedPhotons PackingOf(const PhotonTotals& all, bool coloured, double depositsAtMost); ///< without photons
/// Adds photons to such a packing.
void FillPacking(PackedPhotons& packed, const std::vector<Photon>& photons, const Grid& grid);

/// The same photons in one channel.
/// @param channel  of those that are packed
/// @param colour   what a unit of its power is in the channel that is wanted
/// @param larger   a power of two: the new unit over the old one
PackedPhotons OneChannel(const PackedPhotons& packed, int channel, double colour, double larger);

/// Whole units of power: their sums do not depend on the order of their terms.
inline std::int64_t WholeUnits(float power)
{
  return static_cast<std::int64_t>(static_cast<double>(power) + 0.5);
}

/// Where a line that comes from outside enters the grid, in voxels; `position` itself where that is inside.
/// @param position, direction  in voxels; position is moved
/// @return false where it does not meet the grid
bool MoveOnto(const Grid& grid, std::array<double, 3>& position, const std::array<double, 3>& direction);
}
