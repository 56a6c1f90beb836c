#pragma once

#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "Photons/Marching/MarchMedium.h"
#include "Photons/Photons.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Sums the light of pilot photons in coarse cells (PhotonMarcher::Gather). Each rank begins with the photons that
/// start in its subdomain or enter the volume there. Deposits are integers and are summed over the ranks. The map from
/// voxels to cells is kept between calls.
class PilotGathering
{
public:
  /// Prepares the gathering; keeps references to all arguments.
  /// @param through  the medium of this rank's subdomain; null if it has no voxels
  /// @param traits   traits of the medium in the domain
  PilotGathering(
    const Domain& domain, const MarchMedium* through, const MarchTraits& traits, const MarchSettings& settings)
    : TheDomain(domain)
    , Through(through)
    , Traits(traits)
    , Settings(settings)
  {
  }

  /// Marches pilot photons, and returns their light in the coarse cells. Pilot photons are the few from which an
  /// importance map is computed. Collective.
  /// @param photons, origins  pilot photons and their columns and rows on the photon plane, the same on all ranks
  /// @param cells  number of coarse cells along each axis
  /// @return the light of the domain, on every rank
  PilotLight Gather(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins,
    const std::array<int, 3>& cells, const Monitor& monitor);

private:
  const Domain& TheDomain;
  const MarchMedium* Through;
  const MarchTraits& Traits;
  const MarchSettings& Settings;
  std::array<int, 3> Cells = {}; ///< numbers of cells along each axis with which CellOfVoxel was computed
  Buffer<cl_int> CellOfVoxel;
};
}
