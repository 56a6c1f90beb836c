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
/// What a rank says of its block before ranks cast theirs one by one.
struct BlockToCast
{
  bool able = false;                            ///< it is known how; also where there is no block
  std::vector<double> ofFilter;                 ///< its properties
  double ofArrays = 0.0;                        ///< a number for which arrays there are, and what of field data is used
  MediumRayCaster::SharedNumbers ofBlocks = {}; ///< MediumRayCaster::SharedByBlocks
};

/// Whether all ranks are able to, and say the same: the same on all ranks, which all have to ask.
bool CanCast(Communicator& communicator, const BlocksOfRanks& blocks, const BlockToCast& own);

/// Ranks that see a medium together.
struct SeeingRanks
{
  Communicator& communicator;
  vtkAlgorithm* filter; ///< says how far it is
  const BlocksOfRanks& blocks;
  PictureInBlocks& ofBlock;
  MediumRayCaster* caster; ///< of this rank's block; null: it has none
};

/// A picture of a medium that is spread over ranks, of which each casts its block and gets a part: that of one rank
/// with the whole, to rounding (numerics.md, section 14.9). All ranks have to construct it and to call its functions in
/// the same order; what fails on one throws on all, and so does an abort.
class PictureOfBlocks
{
public:
  /// @param seen    must stay
  /// @param part    pixels that this rank gets
  /// @param counted those of them that no other rank counts (Exposure)
  PictureOfBlocks(const SeeingRanks& seen, const Camera& camera, const std::array<int, 2>& size, const PixelRect& part,
    const PixelRect& counted);

  /// @return the part
  Picture Take() const;

  /// AutomaticExposure of the whole picture.
  /// @param part        as Take made it
  /// @param background  whether it is seen behind the medium
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

/// Pixels that are this rank's alone, of a picture that is divided among all.
PixelRect OwnPixels(const Communicator& communicator, const std::array<int, 6>& all);

/// The least rectangle around both.
PixelRect Around(const PixelRect& a, const PixelRect& b);

/// What is on all lists that say anything, in the order of the first: ranks without a block say nothing. All ranks call
/// it.
std::vector<std::string> OnAllLists(Communicator& communicator, const std::vector<std::string>& own, bool says);
}
