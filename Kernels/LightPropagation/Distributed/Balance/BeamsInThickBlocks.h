#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "LightPropagation/Distributed/Balance/BlockWithGhosts.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepTally.h"
#include "Lights/Lights.h"

#include <array>
#include <functional>
#include <vector>

namespace tyndall
{
/// Adds the light of a point, spot or rectangle lamp to a deposit of the rank's block.
using NearLampAdder = std::function<SweepTally(const Light& lamp, const Deposit& to, const Monitor& monitor)>;

/// Uncollided light of lamps in thick voxels of a grid that is spread over ranks, and the part of it that
/// passes voxels' faces at once where it is first scattered (LampPassing.h). All ranks call it together.
class BeamsInThickBlocks
{
public:
  /// With ghosts, 1/length: sigma_s of the block alone is looked at. Must stay.
  struct Coefficients
  {
    const Buffer<float>& sigma_t;
    const Buffer<float>& sigma_a;
    const Buffer<float>& sigma_s;
  };
  /// @param device, communicator, block  must stay
  /// @param whole  the layout of the whole grid, and
  /// @param periodic  its axes whose ends touch
  BeamsInThickBlocks(Device& device, Communicator& communicator, const BlockWithGhosts& block,
    const VolumeLayout& whole, const std::array<bool, 3>& periodic, const Coefficients& medium);

  /// @param addNear  follows point, spot and rectangle lamps; directional ones go along rays of sweeps
  /// @param path  of the block, W length, added to
  /// @param more  of the block: its flux and the cells of the box's faces are added to, where they are there
  SweepTally Add(const Light& lamp, const SweepMaker& makeSweep, const NearLampAdder& addNear, Buffer<float>& path,
    const Deposit& more, const Monitor& monitor);

  /// To be called when all were added: what Passed and OfLamps have of other ranks' voxels.
  void Finish();
  // With ghosts, as DiffusionSystem::Arrays has them.
  const Buffer<float>& Passed() const { return this->ThroughFaces; }
  const Buffer<float>& OfLamps() const { return this->InVoxels; }

private:
  SweepTally FollowBeam(const Light& lamp, const SweepMaker& makeSweep, const Deposit& more, const Monitor& monitor);
  void FindFirstMoments(const Light& lamp);
  void PassFaces();

  Device& TheDevice;
  Communicator& Others;
  const BlockWithGhosts& Block;
  const VolumeLayout Whole;
  const std::array<bool, 3> Periodic;
  Coefficients TheMedium;
  Buffer<float> OwnPath, OwnSixfold; ///< of a lamp, over the block; its currents, or of a near one first moments
  Buffer<float> Path, Currents, BeamPath, FirstMoments; ///< the same, with ghosts
  Buffer<float> PathOfAll, ThroughFaces, InVoxels;      ///< of all, with ghosts
};
}
