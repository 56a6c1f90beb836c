#pragma once

#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Photons.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Gathers pilot photons in coarse cells (PhotonMarcher::Gather). Each rank starts those that set off in its block;
/// what they leave in cells, whole numbers, is summed over ranks. Keeps between calls which voxels belong to which
/// cell.
class PilotGathering
{
public:
  /// What is given must outlive this.
  /// @param through  this rank's block; null: it has no voxels
  /// @param traits   of all blocks
  PilotGathering(
    const Domain& domain, const MarchMedium* through, const MarchTraits& traits, const MarchSettings& settings)
    : TheDomain(domain)
    , Through(through)
    , Traits(traits)
    , Settings(settings)
  {
  }

  /// Collective. @param photons, origins  the same on all ranks @return the light of the whole grid, on each rank
  PilotLight Gather(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins,
    const std::array<int, 3>& cells, const Monitor& monitor);

private:
  const Domain& TheDomain;
  const MarchMedium* Through;
  const MarchTraits& Traits;
  const MarchSettings& Settings;
  std::array<int, 3> Cells = {}; ///< along each axis, that CellOfVoxel is of
  Buffer<cl_int> CellOfVoxel;
};
}
