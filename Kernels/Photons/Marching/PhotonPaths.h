#pragma once

#include "Distribution/Domain.h"
#include "Photons/Marching/MarchMedium.h"

#include <vector>

namespace tyndall
{
/// The paths of photons through a medium, corner by corner, each put together of its parts in ranks' blocks.
/// Collective.
/// @param through  this rank's block; null: it has no voxels
/// @param photons  the same on all ranks
/// @param numbers  of these
/// @return on rank 0 the paths, by their photons' numbers, ascending; on the others none
std::vector<PhotonPath> TracePaths(const Domain& domain, const MarchMedium* through, const std::vector<Photon>& photons,
  const std::vector<std::size_t>& numbers, int eventLimit);
}
