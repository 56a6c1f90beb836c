#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Communicator.h"
#include "LatticeBoltzmann/Distributed/LatticeSceneInBlocks.h"
#include "LatticeBoltzmann/Distributed/SteppedInBlocks.h"
#include "LatticeBoltzmann/Lattice.h"
#include "LatticeBoltzmann/LatticeBox.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "LatticeBoltzmann/Settling.h"
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

  double Thickest() const { return this->Voxels->thickest; }                  ///< sigma_t h, of all voxels of all ranks
  Lattice* TheLattice() { return this->Photons ? &*this->Photons : nullptr; } ///< null: the rank has no voxels
  const LatticeVoxels& TheVoxels() const { return *this->Voxels; }            ///< the known ones
  /// The steady lattice, or one that steps.
  void Solve(const Monitor& monitor);
  void Step(int steps);
  /// Takes uncollided light that has changed, on this rank.
  void Shine();
  /// Steps on, from densities that other steps have left.
  void Settle(const StepsBefore& before, const Monitor& monitor);
  /// Scattered light of the rank's block beside the uncollided one, and where all power of that went.
  void AddTo(LightField& light);

private:
  void ReduceGlobals();
  SteppedInBlocks& Stepping();
  void KeepOwn();
  void EndSteps();

  Device& TheDevice;
  Communicator& Comm;
  const LatticeSceneInBlocks& Scene;
  const LatticeSettings& Settings;
  const LatticeSettings OfKnown, OfOwn; ///< of lattices of all voxels that this rank steps, and of its own ones
  const Uncollided& Direct;
  const int Channel;
  const LatticeBox Box; ///< the rank's own voxels
  const VoxelBox Stepped;
  std::optional<LatticeVoxels> Voxels;
  std::optional<Lattice> Photons; ///< of the stepped voxels, in the end of the rank's own ones; none without voxels
  std::optional<SteppedInBlocks> Steps;
  std::vector<float> Fluence;
  std::vector<ConvergenceRow> Rows;
};
}
