#pragma once

#include "Device/Monitor.h"
#include "Photons/Importance/PilotLight.h"
#include "Photons/Marching/MarchLaunch.h"
#include "Photons/Marching/MarchMedium.h"

#include <array>
#include <cstdint>
#include <vector>

namespace tyndall
{
/// @throws InvalidInput where there are not as many origins as photons, or one is out of its range
void CheckOrigins(const std::vector<Photon>& photons, const std::vector<std::array<int, 2>>& origins);
/// Column and row that each photon set out from, as kernels sum them up.
std::vector<cl_ulong> MarksOfOrigins(const std::vector<std::array<int, 2>>& origins, const PackedPhotons& packed);

/// Cells without light.
/// @param cells  asked for, along each axis; more than voxels are cut to them
/// @throws InvalidInput where there are none
PilotLight DarkPilotLight(const Grid& voxels, const std::array<int, 3>& cells, int channels);

/// What pilot photons leave in cells.
class PilotSums
{
public:
  /// @param cellOfVoxel  MarchMedium::Cells; must stay
  PilotSums(
    const MarchMedium& medium, const PackedPhotons& packed, const Buffer<cl_int>& cellOfVoxel, std::size_t cells);
  PilotSums(const PilotSums&) = delete;
  PilotSums& operator=(const PilotSums&) = delete;

  const MarchSums& Target() const { return this->Into; }
  std::vector<std::int64_t> AddUp() const; ///< NumbersOfCell of each cell

private:
  MarchSums Into;
  Buffer<cl_long> Memory;
};
std::size_t NumbersOfCell(const PackedPhotons& packed);

/// The light that such sums are.
/// @param unit  W length, of one unit of power times path
void PutCells(const std::vector<std::int64_t>& sums, const Grid& voxels, const PackedPhotons& packed, double unit,
  PilotLight& light);

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
    const std::array<int, 3>& cells, const Monitor& monitor);

private:
  const MarchMedium& TheMedium;
  std::array<int, 3> Cells = {}; ///< along each axis, that CellOfVoxel is of
  Buffer<cl_int> CellOfVoxel;
};
}
