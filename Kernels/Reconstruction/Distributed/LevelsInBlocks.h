#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Reconstruction/Distributed/PyramidBlocks.h"
#include "Reconstruction/PhotonReconstruction.h"

namespace tyndall
{
/// Light of one level of a pyramid for each voxel (LevelPasses) of light that is spread over ranks by blocks.
///
/// Each rank has its block and 16 voxels round it, of which it makes two levels of each pyramid; levels above, a 64th
/// of the grid, each has of all. Numbers are those of the whole bit for bit until the light is scaled, and so are the
/// levels that are chosen by them.
class LevelsInBlocks
{
public:
  /// @param partition  as many blocks as ranks; all that is given must stay
  LevelsInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition,
    const ReconstructionSettings& settings, const Monitor& monitor);

  /// @param light  checked, of the rank's block; looked at by nobody where that has no voxels
  /// @param channels, directions  of the light of all ranks
  /// @return arrays of the block; bias is of the whole. All ranks call it, and each throws what one of them does
  ReconstructedLight Run(const NoisyLight& light, int channels, bool directions);

private:
  struct Around;
  struct Local;
  Around Gather(const NoisyLight& light, int channels, bool directions) const;
  double WeightStep(const NoisyLight& light) const;
  void CompletePyramids(Local* local, int channels, bool directions);
  ReconstructedLight Kept(Local* local, const NoisyLight& light, int channels);

  Device& TheDevice;
  Communicator& Comm;
  const BlockPartition& Partition;
  const ReconstructionSettings& Settings;
  const Monitor& TheMonitor;
  const int Levels;
  const PyramidBlocks Blocks;
};
}
