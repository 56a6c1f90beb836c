#pragma once

#include "Distribution/Domain.h"
#include "Photons/Marching/MarchMedium.h"

#include <vector>

namespace tyndall
{
/// Traces the paths of photons through a medium as corners, joining the parts from all ranks' blocks. Collective.
/// @param through  this rank's block; null if it has no voxels
/// @param photons  the same on all ranks
/// @param numbers  indices of the photons to trace
/// @return the paths on rank 0, ascending by photon index; nothing on other ranks
std::vector<PhotonPath> TracePaths(const Domain& domain, const MarchMedium* through, const std::vector<Photon>& photons,
  const std::vector<std::size_t>& numbers, int eventLimit);
}
