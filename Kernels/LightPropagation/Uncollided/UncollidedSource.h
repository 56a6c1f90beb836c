#pragma once

#include "Device/Device.h"
#include "Device/Monitor.h"
#include "LightPropagation/Angular/AngularBasis.h"
#include "LightPropagation/Sweep/BeyondFaces.h"
#include "LightPropagation/Sweep/SweepOperator.h"
#include "LightPropagation/Sweep/SweepVolume.h"
#include "Lights/Lights.h"

#include <functional>

namespace tyndall
{
/// The medium that uncollided light goes through, and where it is put down.
struct UncollidedVolume
{
  Device& device;
  const VolumeLayout& layout;
  const Buffer<float>& sigma_t; ///< 1/length
  const std::array<bool, 3>& periodic;
  SweepMaker makeSweep; ///< for light that goes along sets of parallel rays
  Deposit deposit;
  /// Of the angular moments that the deposit's path has; null: it has none. Sources then leave net flux to the moments.
  const AngularBasis* basis = nullptr;
  /// Of a parallel beam whose own path integrals, W length, [channel][stride], are asked for too; else null.
  const Buffer<float>* beamPath = nullptr;
  /// Follows the light of a point, spot or rectangle lamp; empty: DepositLamp (LampBeams.h).
  std::function<SweepTally(const SweepVolume& ofChannels, const Light& lamp, const Monitor& monitor)> followLamp = {};
  /// The grid that rays go through, where the medium here is a block of it (`makeSweep` knows of the others); null: the
  /// layout's.
  const Grid* whole = nullptr;
  /// Of such a block, of what goes in through voxels' faces; empty: the layout's grid is the whole.
  FetchBeyondFaces fetchBeyond = {};
  /// Of such a block, Communicator::Collective of all ranks that share the grid; empty: the medium is in one memory.
  std::function<void(const std::function<void()>& work)> together = {};

  /// What may fail on one rank before light is swept by all together. All ranks call it.
  void Collective(const std::function<void()>& work) const { this->together ? this->together(work) : work(); }
  const Grid& Whole() const { return this->whole ? *this->whole : this->layout.grid; }
};

/// Light up to where it first meets the medium: the uncollided flux of one lamp, of all that shines through the box's
/// faces, of a small bright part of the medium (numerics.md, section 5). Found once a solve; what of it is scattered is
/// the first source.
class UncollidedSource
{
public:
  virtual ~UncollidedSource() = default;

  /// Adds its path integrals, and flux and first moments where the deposit has arrays for them, to the deposit. By
  /// blocks all ranks call it: arrays that do not fit on one fail on all of them (UncollidedVolume::Collective) before
  /// their last step together; what goes wrong after it perhaps does on one alone.
  /// @return what came in, what left, what still goes round a periodic axis
  virtual SweepTally AddTo(const UncollidedVolume& volume, const Monitor& monitor) const = 0;

  /// AddTo returns what a rank's own voxels take, not the tally of all ranks.
  virtual bool TalliesOwnVoxels() const { return false; }
};

/// Follows light through the channels of each sigma_t in turn.
/// @param add  from a volume of some channels, the first of them and a monitor to their tally
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
