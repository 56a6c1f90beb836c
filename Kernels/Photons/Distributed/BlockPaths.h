#pragma once

#include "Photons/Marching/MarchShared.h"
#include "Photons/Marching/PhotonPaths.h"

#include <vector>

namespace tyndall
{
/// Follows the ways of photons through one block of a grid, corner by corner, as far as the block goes.
class BlockPaths
{
public:
  /// @param medium  must stay
  BlockPaths(const MarchMedium& medium, int channels);

  /// Corners of a photon's way through the block, once: where it sets off, turns and ends.
  struct Part
  {
    cl_ulong photon = 0; ///< its mark
    std::vector<cl_float4> corners;
  };
  /// Of photons that set off in the block, and of some that have come from other blocks. @return those that go on in
  /// others
  std::vector<PhotonOnItsWay> Start(
    const PackedPhotons& photons, const std::vector<cl_ulong>& marks, std::vector<Part>& parts);
  std::vector<PhotonOnItsWay> Resume(const std::vector<PhotonOnItsWay>& arrived, std::vector<Part>& parts);

private:
  std::vector<PhotonOnItsWay> Trace(const PackedPhotons& photons, const std::vector<PhotonOnItsWay>& arrived,
    const std::vector<cl_ulong>& marks, bool resumes, std::vector<Part>& parts);

  const MarchMedium& Medium;
  int Channels;
  cl::Kernel Kernel;
};
}
