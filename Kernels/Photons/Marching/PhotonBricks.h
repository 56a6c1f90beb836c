#pragma once

#include "Device/Buffer.h"
#include "Medium/FilledBricks.h"

#include <vector>

namespace tyndall
{
/// Memory layout by bricks, for the medium and for the sums of deposits: a filled brick has a record for each of its
/// voxels, x fastest; an empty brick has a single record. Record 0 stands for everything outside the grid.
class PhotonBricks
{
public:
  PhotonBricks() = default; ///< no bricks: arrays are stored voxel by voxel
  PhotonBricks(Device& device, const FilledBricks& bricks, const Grid& grid);

  bool AreThere() const { return this->RecordCount > 0; }
  std::size_t Records() const { return this->RecordCount; }
  std::size_t Count() const { return this->Begin.size(); }
  /// First record of each filled brick; for an empty brick, its record number, negated (less than 0).
  const Buffer<cl_int>& First() const { return this->OnDevice; }

  struct Coefficients
  {
    /// [channels][records], times the voxel diagonal, as pack_extinction in PhotonMedium.cl computes it by voxels.
    std::vector<float> extinction;
    std::vector<float> sigmaA, sigmaS; ///< [records][components]
  };
  /// @param aComponents, sComponents  components of sigma_a and sigma_s in the medium, or 0 to leave them out
  Coefficients Pack(const Medium& medium, double diagonal, int channels, int aComponents, int sComponents) const;

private:
  /// Calls act(first record, first voxel, count) for each row of voxels along x in filled bricks, on all cores.
  template <class Act>
  void ForFilled(const Act& act) const;

  Grid Voxels;
  std::array<int, 3> BrickCount = { 0, 0, 0 };
  std::size_t RecordCount = 0;
  std::vector<cl_int> Begin;
  Buffer<cl_int> OnDevice;
};
}
