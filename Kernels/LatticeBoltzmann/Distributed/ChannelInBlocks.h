#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Communicator.h"
#include "LatticeBoltzmann/Distributed/LatticeSceneInBlocks.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "Light/LightField.h"

#include <optional>
#include <vector>

namespace tyndall
{
/// One channel of a lattice over ranks, as LatticeChannel is of the whole: this rank's block of it, solved in step with
/// the other ranks. All ranks make one and call it together, and each throws what any of them throws.
class ChannelInBlocks
{
public:
  /// What is given must stay.
  /// @param direct  by known voxel
  ChannelInBlocks(Device& device, Communicator& communicator, const LatticeSceneInBlocks& scene,
    const LatticeSettings& settings, const Uncollided& direct, int channel);
  ChannelInBlocks(const ChannelInBlocks&) = delete;
  ChannelInBlocks& operator=(const ChannelInBlocks&) = delete;

  double Thickest() const { return this->Voxels->thickest; } ///< sigma_t h, of all voxels of all ranks
  void Solve(const Monitor& monitor);
  /// Scattered light of the rank's block beside the uncollided one, and where all power of that went.
  void AddTo(LightField& light);

private:
  void ReduceGlobals();

  Device& TheDevice;
  Communicator& Comm;
  const LatticeSceneInBlocks& Scene;
  const LatticeSettings& Settings;
  const LatticeSettings OfKnown; ///< of the known voxels, which go on beyond periodic ends
  const Uncollided& Direct;
  const int Channel;
  const LatticeBox Box; ///< the rank's own voxels
  std::optional<LatticeVoxels> Voxels;
  std::optional<Lattice> Photons; ///< of the rank's block; none without voxels
  std::vector<float> Fluence;
  std::vector<ConvergenceRow> Rows;
};
}
