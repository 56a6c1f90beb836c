#pragma once

#include "Photons.h"

#include "../Medium/Grid.h"

namespace tyndall
{
/// Photons as the kernels want them: on the volume, in voxels, near ones next to each other.
struct PackedPhotons
{
  int channels = 1;                 ///< 1 where all photons have the same colour and one is enough, else 3
  Rgb colour = { 1.0, 1.0, 1.0 };   ///< that the one channel stands for; white: (1, 1, 1)
  double unit = 1.0;                ///< W of one unit of power, a power of two
  std::vector<float> values;        ///< position (voxels), unit direction, `channels` of power (units) of each photon
  std::vector<std::size_t> numbers; ///< which of the photons given it is
  Rgb entered = {};                 ///< W, by channel
  std::size_t missed = 0;           ///< photons that do not meet the volume

  std::size_t Count() const { return this->numbers.size(); }
  int FloatsEach() const { return 6 + this->channels; }
};

/// @param coloured       keep three channels even where one would do
/// @param creditsAtMost  of one photon: power is scaled so that no sum of that many credits can exceed 2^62
/// @throws InvalidInput where a photon's position, direction or power is not finite, its direction zero, its power negative
PackedPhotons Pack(const std::vector<Photon>& photons, const Grid& grid, bool coloured, double creditsAtMost);

/// Where a line that comes from outside enters the grid, in voxels; `position` itself where that is inside.
/// @param position, direction  in voxels; position is moved
/// @return false where it does not meet the grid
bool MoveOnto(const Grid& grid, std::array<double, 3>& position, const std::array<double, 3>& direction);
}
