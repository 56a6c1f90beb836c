#pragma once

#include "Device/Monitor.h"
#include "Photons/Importance/PilotLight.h"
#include "Photons/Marching/MarchMedium.h"

namespace tyndall
{
/// What PhotonMarcher::Gather does. Keeps between calls which voxels belong to which cell.
class PilotGathering
{
public:
  /// @param medium  must outlive this
  explicit PilotGathering(const MarchMedium& medium)
    : TheMedium(medium)
  {
  }

  PilotLight Gather(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins,
    std::array<int, 3> cells, const Monitor& monitor);

private:
  const MarchMedium& TheMedium;
  std::array<int, 3> Cells = {}; ///< along each axis, that CellOfVoxel is of
  Buffer<cl_int> CellOfVoxel;
};
}
