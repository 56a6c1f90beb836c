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
/// Upper limits of the work in progress on a rank, in addition to its block: the memory for it does not grow with the
/// medium, the picture or the number of ranks.
struct WorkAtOnce
{
  /// voxels of one block for which shadow rays are traced at a time
  std::size_t voxels = ShadowsInBlocks::PortionVoxels;
  /// Primary rays that travel between ranks at a time, summed over all ranks: at least those of four rows of pixels,
  /// fewer if a device has too little memory. Rays split off from them are not counted. 140 bytes each.
  std::size_t rays = 131072;
};

/// A rank's contribution to the picture of a domain that is decomposed into blocks (numerics.md, section 14.9). A rank
/// stores its own block with halos only.
///
///  - Straight rays: each rank renders its block, and the pictures are composited (BlockPixels.h).
///  - Rays that bend, or meet a table: they travel from rank to rank in rounds, as photons do, a few rows of pixels at
///    a time. A step is taken on the rank whose block contains its midpoint; entry into and exit from the grid are
///    computed with the coordinates of the whole domain, so that the rays do not depend on the decomposition.
///  - Shadow rays: each rank computes the optical length, within its block, of the paths from other blocks' voxels to a
///    light; these are summed (ShadowsInBlocks.h).
///
/// The constructor and Take are collective; ranks without voxels take part.
class PictureInBlocks
{
public:
  /// Combines the ranks' shared scene properties, before they construct their casters; the result is the same on all
  /// ranks. Collective.
  /// @param own  properties of this rank's block; null: it has no voxels
  static SharedScene Shared(Communicator& communicator, const SharedScene* own);

  /// @param communicator, partition, held  must outlive this object
  /// @param held  for each rank, the voxels its arrays cover, ghost cells included
  /// @param own   caster of this rank's block, for the medium in the box held[rank]; null: it has no voxels
  /// @param atOnce  the same on all ranks
  PictureInBlocks(Communicator& communicator, const BlockPartition& partition, const std::vector<VoxelBox>& held,
    MediumRayCaster* own, const WorkAtOnce& atOnce = {});

  /// Whether rays travel from rank to rank; the same on all ranks. If so, a rank's picture is already attenuated by the
  /// other blocks.
  bool GoesInRounds() const { return this->InRounds; }

  /// Computes this rank's contribution to the picture: that of its block, or, if GoesInRounds(), of the rays that end
  /// in it. Collective.
  /// @param size  pixels
  /// @throws  collective error: what one rank throws, all throw
  Picture Take(const Camera& camera, const std::array<int, 2>& size, const Monitor& monitor = {});

  /// Rays that this rank has sent to others so far.
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
