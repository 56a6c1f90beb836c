#pragma once

#include "Device/Buffer.h"
#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "LatticeBoltzmann/Distributed/MediumAround.h"
#include "LatticeBoltzmann/LatticeScene.h"
#include "LatticeBoltzmann/LatticeSettings.h"
#include "LatticeBoltzmann/LatticeVoxels.h"
#include "LightPropagation/Problem/UnvaryingAxes.h"
#include "LightPropagation/Sweep/Pipelined/SweepInBlocks.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/Uncollided/Lamps/LampsInBlocks.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <memory>
#include <vector>

namespace tyndall
{
/// Uncollided light of lamps and of the environment in a medium that is spread over ranks, along the maps' rays, as
/// FindUncollided has it of the whole; or that which is given.
class UncollidedInBlocks
{
public:
  /// All ranks make one together, and all of it must stay.
  /// @param partition  in the units of the scene
  /// @param scene  of the known voxels
  /// @param firstMoments  of lamps' light are asked for
  UncollidedInBlocks(Device& device, Communicator& communicator, const BlockPartition& partition, const Halo& around,
    const LatticeScene& scene, const LatticeSettings& settings, bool firstMoments);

  /// By known voxel; power that escaped or was lost on the first rank that has voxels, on the others 0. Collective.
  Uncollided Find(const Monitor& monitor);

private:
  std::unique_ptr<SweepOperator> MakeSweep(const SweepRequest& request);
  void AddEnvironment(const Monitor& monitor);
  void AddLamp(const Light& lamp, const Monitor& monitor);
  void AddMoments(const Light& lamp, const Buffer<float>& path, const Buffer<float>& currents);
  UncollidedVolume Volume();
  Uncollided Given() const;
  Rgb Lost() const;
  void LeaveAlone(std::vector<float>& moments) const;
  std::vector<float> FoundMoments(double scale) const;
  VolumeLayout LayoutOn(const Grid& grid) const { return { grid, this->Scene.channels, this->SharedExtinction }; }
  Buffer<float> SigmaTOf(const VolumeLayout& layout, const LatticeBox& box) const;
  Buffer<float> Zeros(const VolumeLayout& layout, int parts, const char* what) const;
  std::vector<float> Known(const Buffer<float>& planar, double scale, int components) const;
  Deposit ToOwn() const { return { &this->Path, this->Flux.Size() > 0 ? &this->Flux : nullptr }; }

  Device& TheDevice;
  Communicator& Comm;
  const UnvaryingAxes Unvarying;
  const BlockPartition Partition; ///< as rays go through it: wide along axes on which nothing changes
  const double Narrowing;         ///< volume of a voxel over that
  const Halo& Around;
  const LatticeScene Scene;
  const LatticeSettings& Settings;
  const bool FirstMoments, SharedExtinction;
  const VolumeLayout Layout, KnownLayout;
  Buffer<float> SigmaT, KnownSigmaT, Path, Flux;
  Buffer<float> KnownMoments, OwnMoments;   ///< of beams, and of near lamps; empty: not asked for
  std::unique_ptr<LampsInBlocks> NearLamps; ///< null until there is one
  BlockWorkspace Workspace;
  std::vector<Light> Lamps;
  const bool IsGiven; ///< light of another solver, on any rank
  SweepTally Tally;
};
}
