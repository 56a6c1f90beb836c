#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Sweep/Pipelined/AcrossFaces.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "Lights/Lights.h"

#include <array>
#include <vector>

namespace tyndall
{
/// Medium that uncollided light crosses, and the arrays to which the light is added.
struct UncollidedVolume
{
  Device& device;
  const Domain& domain;
  const VolumeLayout& layout;   ///< memory layout of this rank's block
  const Buffer<float>& sigma_t; ///< extinction, 1/length
  const std::array<bool, 3>& periodic;
  SweepMaker makeSweep; ///< factory of sweeps of the domain along sets of parallel rays
  Deposit deposit;
  /// Basis of the angular moments in the deposit's path; null: no angular moments. With a basis, sources do not deposit
  /// net flux, which the moments contain.
  const AngularBasis* basis = nullptr;
  /// Receives the path integrals of a parallel beam, separately from other light, W length, [channel][voxel]; null: not
  /// needed.
  const Buffer<float>* beamPath = nullptr;
  /// With several ranks: fetches the power that enters voxels beyond the block's faces; empty: the block is the domain,
  /// or no first moments are computed.
  FetchBeyondFaces fetchBeyond = {};
};

/// Source of uncollided flux: one lamp, the light through the box's faces, or a localised emission in the medium
/// (numerics.md, section 5). Computed once per solve; the light that it scatters is the first-collision source.
class UncollidedSource
{
public:
  virtual ~UncollidedSource() = default;

  /// Adds the path integrals of this source, and net flux and first moments if the deposit has arrays for them, to the
  /// deposit. Collective. An error on one rank becomes an error on all ranks, except after the last collective step,
  /// where it may occur on one rank alone.
  /// @return incident power, escaped power, and power in transit along periodic axes, W
  virtual SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const = 0;

  /// Whether AddTo() returns the energy balance of this rank's own voxels; false: it returns that of the whole domain.
  virtual bool TalliesOwnVoxels() const { return false; }
};

/// Calls `add` for each group of channels that share one sigma_t.
/// @param add  function (volume of the group's channels, first channel, monitor) that returns a tally
/// @return the sum of the tallies
template <class AddGroup>
SweepTally AddByGroups(const UncollidedVolume& volume, const Monitor& monitor, const AddGroup& add)
{
  SweepTally tally;
  const std::vector<ChannelGroup> groups = volume.layout.Groups();
  for (std::size_t g = 0; g < groups.size(); ++g)
  {
    const double all = static_cast<double>(groups.size());
    const Monitor ofGroup = OfPart(monitor, g / all, (g + 1) / all);
    const SweepVolume ofChannels = GroupVolume(volume.layout, groups[g], volume.sigma_t, volume.deposit);
    Add(tally, add(ofChannels, groups[g].first, ofGroup), groups[g].first);
  }
  return tally;
}
}
