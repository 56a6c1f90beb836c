#pragma once

#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "LightPropagation/Sweep/Pipelined/AcrossFaces.h"
#include "LightPropagation/Sweep/Pipelined/SweepInBlocks.h"
#include "LightPropagation/Sweep/SweepInMemory.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/VolumeLayout.h"
#include "LightPropagation/Uncollided/UncollidedSource.h"

#include <array>
#include <memory>

namespace tyndall
{
/// How rays get through the grid: the only place that chooses between a serial sweep and one that is pipelined over
/// ranks. Owns the arrays that sweeps share.
class BlockTransport
{
public:
  /// Not collective: may throw on one rank alone.
  /// @param device, domain, layout, sigma_t  must outlive this; layout and extinction of this rank's block
  BlockTransport(Device& device, const Domain& domain, const VolumeLayout& layout, const Buffer<float>& sigma_t,
    const std::array<bool, 3>& periodic);

  /// Chooses and makes an implementation of the sweep; no other function does. Collective.
  std::unique_ptr<SweepOperator> MakeSweep(const SweepRequest& request);
  /// Whether MakeSweep can sweep a part of the grid (SweepRequest::box).
  bool SweepsParts() const { return this->TheDomain.IsSerial(); }
  /// Fetches the values beyond the faces of this block from its neighbours. Collective.
  /// @param byFaces  values by face of each voxel, [channel][face][stride]
  BeyondFaces FetchBeyond(const Buffer<float>& byFaces);
  /// What an uncollided source needs to deposit its light in all blocks.
  UncollidedVolume VolumeOf(const Deposit& deposit, const AngularBasis* basis);

private:
  Device& TheDevice;
  const Domain& TheDomain;
  const VolumeLayout& Layout;
  const Buffer<float>& SigmaT;
  const std::array<bool, 3> Periodic;
  SweepWorkspace Workspace;
  BlockWorkspace PipelineWorkspace;
  std::unique_ptr<AcrossFaces> Across; ///< null: the block is the domain
};
}
