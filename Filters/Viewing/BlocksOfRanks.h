#pragma once

#include "Common/ImageInput.h"
#include "Distribution/Domain.h"
#include "Pieces/PieceBlocks.h"
#include "Viewing/Blocks/BlockPixels.h"
#include "Viewing/Scene/BlockOfScene.h"
#include "Viewing/Scene/Camera.h"
#include "Viewing/Scene/ViewSettings.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

class vtkImageData;

namespace tyndall
{
/// An image that is distributed over ranks, or the complete image on one rank. Each rank has a block of its voxels, and
/// may have ghost cells, flagged as duplicates. Exchange is collective, also for ranks without a block.
class BlocksOfRanks
{
public:
  /// Serial.
  /// @throws InvalidInput as GridOf
  explicit BlocksOfRanks(vtkImageData* whole);
  /// Collective.
  /// @param communicator  must outlive this object
  /// @param image  this rank's piece; null or without cells if it has no block
  BlocksOfRanks(Communicator& communicator, vtkImageData* image);

  /// Whether the blocks tile one grid: each of its voxels is in exactly one block. The same on all ranks.
  bool MakeUpTheWhole() const { return this->Pieces.MakeUpTheWhole(); }
  bool HasOwn() const { return this->OwnBlock.OwnVoxels() > 0; }
  const GridBlock& Own() const { return this->OwnBlock; }
  const OwnAxes& Axes() const { return this->AxesOfAll; }

  // Only if MakeUpTheWhole; in voxels of the whole grid, and in Axes.
  const Domain& Over() const { return this->Pieces.GetDomain(); }
  const Grid& Whole() const { return this->Over().Whole(); }
  /// Voxels of each rank's input image, by rank: block and ghost cells.
  const std::vector<VoxelBox>& Given() const { return this->Pieces.HeldByRanks(); }
  /// Whether `held` equals Given.
  bool AreGiven(const std::vector<VoxelBox>& held) const;
  /// Voxels that each rank needs to render its block (HeldBox), by rank; Given, if that is enough on all ranks.
  std::vector<VoxelBox> HeldFor(const ViewSettings& settings, bool moments, bool surface) const;

  /// ExchangePixels for a camera in the scene's coordinates.
  std::optional<SeenBlocks> Exchange(
    const BlockPixels& own, const PixelRect& wanted, bool failed, const Camera& camera) const;

private:
  PieceBlocks Pieces;
  OwnAxes AxesOfAll;
  GridBlock OwnBlock; ///< without voxels if this rank has none, or if the domain is serial
};

/// Whether the blocks tile one grid and all ranks are able to render them: with equal properties, and those that have a
/// block with equal arrays. Collective, the same on all ranks.
/// @param able        whether this rank can render its block; true if it has none
/// @param properties  of the filter
/// @param arrays      hash of which arrays there are, and of the field data used
bool FitTogether(const BlocksOfRanks& blocks, bool able, std::vector<double> properties, double arrays);

/// AutomaticExposure of a picture of which each rank has a part. Collective.
/// @param counted  the part's pixels that this rank alone counts, relative to the part
/// @param background  whether the background is visible behind the medium
double ExposureOfParts(const Domain& domain, const Picture& part, const PixelRect& counted, bool background);

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
