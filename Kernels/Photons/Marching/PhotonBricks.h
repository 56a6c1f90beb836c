#pragma once

#include "Device/Buffer.h"
#include "Medium/FilledBricks.h"

#include <vector>

namespace tyndall
{
/// Where a medium, and what photons leave in it, stand in memory by bricks: a filled brick has a record for each of its
/// voxels, x fastest, an empty one a single record. Record 0 is all that is outside of the grid.
class PhotonBricks
{
public:
  PhotonBricks() = default; ///< none: everything stands voxel by voxel
  PhotonBricks(Device& device, const FilledBricks& bricks, const Grid& grid);

  bool AreThere() const { return this->RecordCount > 0; }
  std::size_t Records() const { return this->RecordCount; }
  std::size_t Count() const { return this->Begin.size(); }
  /// [brick] the first record of a filled one; of an empty one less than 0: the number of its record, negated.
  const Buffer<cl_int>& First() const { return this->OnDevice; }

  struct Coefficients
  {
    std::vector<float> extinction;     ///< [channels][records], over `diagonal`, as PhotonMedium.cl has it by voxels
    std::vector<float> sigmaA, sigmaS; ///< [records][components]
  };
  /// @param aComponents, sComponents  the medium's own, or 0: not wanted
  Coefficients Pack(const Medium& medium, double diagonal, int channels, int aComponents, int sComponents) const;

private:
  /// Calls act(first record, first voxel, count) for rows of voxels along x of filled bricks, on all cores.
  template <class Act>
  void ForFilled(const Act& act) const;

  Grid Voxels;
  std::array<int, 3> BrickCount = { 0, 0, 0 };
  std::size_t RecordCount = 0;
  std::vector<cl_int> Begin;
  Buffer<cl_int> OnDevice;
};
}
