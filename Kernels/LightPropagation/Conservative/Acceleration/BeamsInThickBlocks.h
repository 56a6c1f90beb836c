#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "LightPropagation/Diffusion/BlockWithGhosts.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepTally.h"

#include <cstddef>
#include <functional>

namespace tyndall
{
/// Adds the light of a lamp, by its number, to a deposit of the rank's block.
using LampAdder = std::function<SweepTally(std::size_t lamp, const Deposit& to, const Monitor& monitor)>;

/// Uncollided light of lamps in thick voxels of a grid that is spread over ranks, and the part of it that
/// passes voxels' faces at once where it is first scattered (LampPassing.h). All ranks call it together.
class BeamsInThickBlocks
{
public:
  /// With ghosts, 1/length: sigma_s of the block alone is looked at. Must stay.
  struct Coefficients
  {
    const Buffer<float>& sigma_t; ///< that light diffuses with
    const Buffer<float>& sigma_a;
    const Buffer<float>& sigma_s;
    const Buffer<float>& swept; ///< sigma_t of the sweeps
  };
  /// @param device, communicator, block  must stay
  /// @param pathFloats  of the block's path integrals, with their angular moments
  BeamsInThickBlocks(Device& device, Communicator& communicator, const BlockWithGhosts& block, std::size_t pathFloats,
    const Coefficients& medium);

  /// @param path  of the block, W length, added to
  /// @param more  of the block: its flux and the cells of the box's faces are added to, where they are there
  SweepTally Add(
    std::size_t lamp, const LampAdder& add, Buffer<float>& path, const Deposit& more, const Monitor& monitor);

  /// To be called when all were added: what Passed and OfLamps have of other ranks' voxels.
  void Finish();
  // With ghosts, as DiffusionSystem::Arrays has them.
  const Buffer<float>& Passed() const { return this->ThroughFaces; }
  const Buffer<float>& OfLamps() const { return this->InVoxels; }

private:
  void PassFaces();

  Device& TheDevice;
  Communicator& Comm;
  const BlockWithGhosts& Block;
  Coefficients TheMedium;
  Buffer<float> OwnPath, OwnMoments;               ///< of a lamp, over the block, as Deposit has them
  Buffer<float> Path, FirstMoments;                ///< the same, with ghosts, without angular moments
  Buffer<float> PathOfAll, ThroughFaces, InVoxels; ///< of all, with ghosts
};
}
