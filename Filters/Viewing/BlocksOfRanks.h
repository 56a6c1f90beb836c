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
/// An image that is distributed over ranks, or the complete image on one rank. Each rank has a block of the image's
/// voxels or none, and may have ghost cells, flagged as duplicates.
class BlocksOfRanks
{
public:
  /// Creates the serial case: one block, the complete image.
  /// @throws InvalidInput if the image has no valid grid (GridOf)
  explicit BlocksOfRanks(vtkImageData* whole);
  /// Creates the distributed case, from the pieces of all ranks. Collective.
  /// @param communicator  must outlive this object
  /// @param image  this rank's piece; null or without cells if it has no block
  BlocksOfRanks(Communicator& communicator, vtkImageData* image);

  /// Whether the blocks tile one grid: each voxel of the grid is in exactly one block. The same on all ranks.
  bool MakeUpTheWhole() const { return this->Pieces.MakeUpTheWhole(); }
  bool HasOwn() const { return this->OwnBlock.OwnVoxels() > 0; }
  const GridBlock& Own() const { return this->OwnBlock; }
  const OwnAxes& Axes() const { return this->AxesOfAll; }

  // The following methods are valid only if MakeUpTheWhole(). Boxes are in voxels of the whole grid, along Axes().
  const Domain& Over() const { return this->Pieces.GetDomain(); }
  const Grid& Whole() const { return this->Over().Whole(); }
  /// Voxels of the input image of each rank, ghost cells included, by rank.
  const std::vector<VoxelBox>& Given() const { return this->Pieces.HeldByRanks(); }
  /// Whether the boxes `held`, one per rank, equal the boxes of the input images (Given).
  bool AreGiven(const std::vector<VoxelBox>& held) const;
  /// Voxels that each rank needs to render its block (HeldBox), by rank. If the input image of every rank contains the
  /// voxels that the rank needs, returns the voxels of the input images (Given) instead.
  /// @param moments, surface  whether the light has angular moments, or radiance at the faces
  std::vector<VoxelBox> HeldFor(const ViewSettings& settings, bool moments, bool surface) const;

  /// Exchanges the pixels that the ranks rendered of their blocks (ExchangePixels), for a camera in the scene's
  /// coordinates. Collective, also for ranks without a block.
  /// @return the pixels in `wanted` of all blocks; no value, on all ranks, if `failed` is true on any
  std::optional<SeenBlocks> Exchange(
    const BlockPixels& own, const PixelRect& wanted, bool failed, const Camera& camera) const;

private:
  PieceBlocks Pieces;
  OwnAxes AxesOfAll;
  GridBlock OwnBlock; ///< block of this rank; without voxels if this rank has none, or if the domain is serial
};

/// Whether the ranks can render their blocks together: the blocks tile one grid, every rank can render its block, the
/// properties of all ranks are equal, and so are the arrays of all ranks with a block. Collective, the same on all
/// ranks.
/// @param able        whether this rank can render its block; true if it has none
/// @param properties  the filter's properties as numbers
/// @param arrays      hash of the arrays and field data of this rank's block (ArraysInANumber)
bool FitTogether(const BlocksOfRanks& blocks, bool able, std::vector<double> properties, double arrays);

/// Automatic exposure (AutomaticExposure) of a picture that is distributed over ranks. Collective.
/// @param part     pixels of the picture on this rank; parts of different ranks may overlap
/// @param counted  pixels that only this rank counts, relative to the first pixel of `part`
/// @param background  whether the background is visible behind the medium
double ExposureOfParts(const Domain& domain, const Picture& part, const PixelRect& counted, bool background);

/// Pixels of a picture's extent, as a rectangle.
PixelRect RectOf(const std::array<int, 6>& extent);

/// This rank's share of the pixels of a picture with extent `all`; the shares of the ranks are disjoint.
PixelRect OwnPixels(const Communicator& communicator, const std::array<int, 6>& all);

/// The smallest rectangle that contains both rectangles; an empty rectangle is ignored.
PixelRect Around(const PixelRect& a, const PixelRect& b);

/// Entries that are in the lists of all ranks, in the order of the first list. Collective.
/// @param own   this rank's list
/// @param says  whether this rank has a list; false if it has no block
std::vector<std::string> OnAllLists(Communicator& communicator, const std::vector<std::string>& own, bool says);
}
