#pragma once

#include "Device/Monitor.h"
#include "Distribution/Domain.h"
#include "Distribution/Rounds.h"
#include "Viewing/Blocks/BlockPixels.h"
#include "Viewing/MediumRayCaster.h"
#include "Viewing/Rays/Picture.h"
#include "Viewing/Scene/Camera.h"

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace tyndall
{
/// Upper limits of a rank's work in progress. They bound the memory that a rank needs in addition to its block,
/// whatever the size of the medium, the picture or the number of ranks.
struct WorkAtOnce
{
  /// Voxels for which shadow rays are traced at a time, summed over all ranks, 12 bytes each; at least one row of
  /// voxels per rank.
  std::size_t voxels = 65536;
  /// Primary rays that travel between ranks at a time, summed over all ranks, 140 bytes each. There are fewer if a
  /// device has too little memory, but at least those of four rows of pixels. Rays split off from primary rays are not
  /// counted.
  std::size_t rays = 131072;
};

/// Picture of a domain of which each rank holds its own block with halo (numerics.md, section 14.9). On one rank it is
/// the picture that MediumRayCaster renders.
///
///  - Straight rays: each rank renders its block, and the pictures are composited (BlockPixels.h). A ray is cast again
///    if its result depends on the transmittance of the blocks in front.
///  - Rays that bend or meet a table: they travel from rank to rank in rounds, a few rows of pixels at a time. The rank
///    whose block contains the midpoint of a step computes the step. Entry into and exit from the grid are computed in
///    coordinates of the whole domain, so that the rays do not depend on the decomposition.
///  - Shadow rays: each rank computes the optical length, within its block, of the paths from other blocks' voxels to a
///    light; these lengths are summed.
///
/// The constructor and Take are collective; ranks without voxels also call them.
class PictureInBlocks
{
public:
  /// Reduces the scene properties of all blocks to those of the domain; each rank needs them to construct its caster.
  /// The result is the same on all ranks. Collective.
  /// @param own  properties of this rank's block; null: it has no voxels
  static SharedScene Shared(const Domain& domain, const SharedScene* own);

  /// Prepares pictures of a domain and checks that the ranks agree on the lights. Collective.
  /// @param domain, held  must outlive this object
  /// @param held  by rank, the voxels that the rank's arrays cover, ghost cells included
  /// @param own   caster of this rank's block, for the medium in the box held[rank]; null: the rank has no voxels. On
  ///   one rank: a caster of the whole domain, without a block
  /// @param atOnce  limits of the work in progress, the same on all ranks
  /// @throws InvalidInput  on all ranks, if the lights differ between ranks
  PictureInBlocks(
    const Domain& domain, const std::vector<VoxelBox>& held, MediumRayCaster* own, const WorkAtOnce& atOnce = {});

  /// Renders the picture together with the other ranks. Collective.
  /// @param size  width and height of the picture, pixels
  /// @param part  rectangle of the pixels that this rank wants
  /// @return pixels of `part`: radiance, alpha (of the medium, without the background) and depth
  /// @throws  collective error: what one rank throws, all throw
  Picture Take(
    const Camera& camera, const std::array<int, 2>& size, const PixelRect& part, const Monitor& monitor = {});

  /// Number and bytes of the rays that this rank has sent to other ranks so far.
  const RoundsTraffic& Traffic() const { return this->Between->Traffic(); }

private:
  void Follow(int light, const std::vector<VoxelBox>& portions, const Camera& camera, const Monitor& monitor);
  void FindShadows(const Camera& camera, const Monitor& monitor);
  void FindSources(const Camera& camera, const Monitor& monitor);
  std::vector<RayOnItsWay> Follow(
    const RayPass& pass, std::vector<RayOnItsWay> rays, bool sharp, Picture& picture, const Monitor& monitor);
  void CastInRounds(const Camera& camera, bool sharp, Picture& picture, const Monitor& monitor);
  Picture CastOwn(const Camera& camera, const std::array<int, 2>& size, const Monitor& monitor);
  void LookAgain(const Camera& camera, const std::array<int, 2>& size, BlockPixels& own, const Monitor& monitor);

  const Domain& Over;
  const std::vector<VoxelBox>& Held;
  MediumRayCaster* Own;
  WorkAtOnce AtOnce;
  std::vector<SmallLight> Lights; ///< lights for shadow rays, the same on all ranks
  std::optional<Rounds> Between;
  bool InRounds = false, ByMoments = false;
};

inline const int* WhereIs(const RayOnItsWay& ray)
{
  return ray.where;
}
}
