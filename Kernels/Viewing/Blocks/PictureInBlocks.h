#pragma once

#include "Device/Monitor.h"
#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/Rounds.h"
#include "Viewing/Blocks/ShadowsInBlocks.h"
#include "Viewing/MediumRayCaster.h"
#include "Viewing/Rays/Picture.h"
#include "Viewing/Scene/Camera.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace tyndall
{
/// What ranks work on at once beside their blocks, at most: what that takes does not grow with the medium, the picture
/// or the number of ranks.
struct WorkAtOnce
{
  std::size_t voxels = ShadowsInBlocks::PortionVoxels; ///< of one block, to which shadow rays are followed
  /// Of pixels, on all ranks together, that go from rank to rank, but at least those of four rows; fewer where a device
  /// has no room for them. What is split off them comes besides. 140 bytes each.
  std::size_t rays = 131072;
};

/// A rank's part of a picture of a medium that is spread over ranks by blocks (numerics.md, section 14.9). None holds
/// another's voxels, but for layers round its own.
///
///  - Rays that go straight on: each rank casts its block, and pictures are laid over each other (BlockPixels.h).
///  - Rays that bend, or meet a table: they go from rank to rank, in rounds, as photons do, those of some rows
///    after others. A step is taken where its middle is, a ray begins where it enters the grid and ends where
///    it leaves it: by the numbers that the whole has.
///  - Shadow rays: each rank finds the optical length, in its block, of the ways from other blocks' voxels to a light;
///    these are added up (ShadowsInBlocks.h).
///
/// All ranks construct it and call Take together, also one without voxels.
class PictureInBlocks
{
public:
  /// What ranks say to each other before they make their casters: the same for all.
  /// @param own  of a rank's block; null: it has no voxels
  static SharedScene Shared(Communicator& communicator, const SharedScene* own);

  /// @param communicator, partition, held  must stay
  /// @param held  by rank, the voxels that its arrays have
  /// @param own   of this rank's block, whose medium has its `held`; null: it has no voxels
  /// @param atOnce  the same on all ranks
  PictureInBlocks(Communicator& communicator, const BlockPartition& partition, const std::vector<VoxelBox>& held,
    MediumRayCaster* own, const WorkAtOnce& atOnce = {});

  /// Whether rays go from rank to rank: the same on all. What one shows is not dimmed by others then.
  bool GoesInRounds() const { return this->InRounds; }

  /// What this rank adds to the picture, as of a block: in rounds, what of rays that end here.
  /// @param size  pixels
  /// @throws on all ranks what one of them throws
  Picture Take(const Camera& camera, const std::array<int, 2>& size, const Monitor& monitor = {});

  /// Rays that were handed on by this rank so far.
  const RoundsTraffic& Traffic() const { return this->Between->Traffic(); }

private:
  void FindSources(const Camera& camera, const Monitor& monitor);
  void CastInRounds(const Camera& camera, bool sharp, Picture& picture, const Monitor& monitor);
  std::vector<RayOnItsWay> Follow(
    const MediumRayCaster::Pass& pass, std::vector<RayOnItsWay> rays, bool sharp, Picture& picture, const Monitor& of);
  std::vector<RayOnItsWay> InOrder(std::vector<RayOnItsWay> rays, int width) const;

  Communicator& Comm;
  const BlockPartition& Partition;
  MediumRayCaster* Own;
  ShadowsInBlocks Shadows;
  std::size_t RaysAtOnce;
  std::optional<Rounds> Between;
  bool InRounds = false, ByMoments = false;
};

inline const int* WhereIs(const RayOnItsWay& ray)
{
  return ray.where;
}
}
