#pragma once

#include "BlocksOfRanks.h"

#include "Device/Monitor.h"
#include "Distribution/Communicator.h"
#include "Viewing/Blocks/BlockPixels.h"
#include "Viewing/Blocks/PictureInBlocks.h"
#include "Viewing/MediumRayCaster.h"
#include "Viewing/Scene/Camera.h"

#include <array>
#include <string>
#include <vector>

class vtkAlgorithm;

namespace tyndall
{
/// What ranks compare before each casts rays through its block.
struct BlockToCast
{
  bool able = false;                            ///< whether this rank can cast its block; true if it has no block
  std::vector<double> ofFilter;                 ///< its properties
  double ofArrays = 0.0;                        ///< hash of which arrays there are, and of the field data used
  MediumRayCaster::SharedNumbers ofBlocks = {}; ///< MediumRayCaster::SharedByBlocks
};

/// Whether all ranks are able to cast, with equal properties and arrays. Collective, the same on all ranks.
bool CanCast(Communicator& communicator, const BlocksOfRanks& blocks, const BlockToCast& own);

/// Ranks that render a medium together.
struct SeeingRanks
{
  Communicator& communicator;
  vtkAlgorithm* filter; ///< reports progress
  const BlocksOfRanks& blocks;
  PictureInBlocks& ofBlock;
  MediumRayCaster* caster; ///< of this rank's block; null if it has none
};

/// A picture of a medium that is distributed over ranks: each rank casts rays through its block and receives a part of
/// the picture, equal to a serial one to rounding (numerics.md, section 14.9). Constructor and functions are
/// collective; an error or an abort on one rank throws on all.
class PictureOfBlocks
{
public:
  /// @param seen    must outlive this object
  /// @param part    pixels that this rank receives
  /// @param counted the part's pixels that this rank alone counts for Exposure
  PictureOfBlocks(const SeeingRanks& seen, const Camera& camera, const std::array<int, 2>& size, const PixelRect& part,
    const PixelRect& counted);

  /// @return this rank's part of the picture
  Picture Take() const;

  /// AutomaticExposure of the whole picture.
  /// @param part        as Take returned it
  /// @param background  whether the background is visible behind the medium
  double Exposure(const Picture& part, bool background) const;

private:
  BlockPixels CastOwn(double& farDepth) const;
  void LookAgain(BlockPixels& own) const;

  SeeingRanks Seen;
  Camera TheCamera;
  std::array<int, 2> Size;
  PixelRect Part, Counted;
};

/// The pixels of a picture's extent.
PixelRect RectOf(const std::array<int, 6>& extent);

/// This rank's share of the pixels of a picture; the ranks' shares are disjoint.
PixelRect OwnPixels(const Communicator& communicator, const std::array<int, 6>& all);

/// The smallest rectangle that contains both.
PixelRect Around(const PixelRect& a, const PixelRect& b);

/// Entries that are on the lists of all ranks with `says`, in the order of the first list. Ranks without a block have
/// no list. Collective.
std::vector<std::string> OnAllLists(Communicator& communicator, const std::vector<std::string>& own, bool says);
}
