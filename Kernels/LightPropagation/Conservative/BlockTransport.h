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
/// Makes the sweep operators of a solve: in the memory of one device for a serial domain, pipelined over ranks for a
/// decomposed one. Owns the work arrays that all sweeps of the solve share.
class BlockTransport
{
public:
  /// Not collective: may throw on one rank alone.
  /// @param device, domain, layout, sigma_t  must outlive this object; `layout` and `sigma_t` (extinction, 1/length)
  ///   are those of this rank's block
  BlockTransport(Device& device, const Domain& domain, const VolumeLayout& layout, const Buffer<float>& sigma_t,
    const std::array<bool, 3>& periodic);

  /// Makes the sweep operator for a request. Collective.
  std::unique_ptr<SweepOperator> MakeSweep(const SweepRequest& request);
  /// Whether MakeSweep can restrict a sweep to a box of voxels (SweepRequest::box); true for a serial domain.
  bool SweepsParts() const { return this->TheDomain.IsSerial(); }
  /// Fetches from the neighbouring ranks the values of the voxels just outside the faces of this block. Collective.
  /// @param byFaces  values of this block by voxel face, [channel][face][voxel]
  BeyondFaces FetchBeyond(const Buffer<float>& byFaces);
  /// Describes, for an uncollided source (UncollidedSource.h), the medium that its light crosses and the arrays
  /// `deposit` to which the light is added.
  UncollidedVolume VolumeOf(const Deposit& deposit, const AngularBasis* basis);

private:
  Device& TheDevice;
  const Domain& TheDomain;
  const VolumeLayout& Layout;
  const Buffer<float>& SigmaT;
  const std::array<bool, 3> Periodic;
  SweepWorkspace Workspace;
  BlockWorkspace PipelineWorkspace;
  std::unique_ptr<AcrossFaces> Across; ///< exchange of values across the faces of blocks; null for a serial domain
};
}
