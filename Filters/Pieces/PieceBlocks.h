#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/VoxelBox.h"

#include "vtkSmartPointer.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

class vtkAlgorithm;
class vtkImageData;
class vtkInformation;
class vtkInformationVector;
class vtkMultiProcessController;

namespace tyndall
{
/// The blocks of one grid that ranks have of an image, for filters that work on pieces of it. All ranks make one.
///
/// Each rank is given a piece, in which cells that it has of its neighbours are flagged as duplicates (vtkGhostType);
/// or each is given all of it by a source that knows no pieces, and its block is what it is asked for.
class PieceBlocks
{
public:
  /// @param asked  the output that is made; null: nothing is, and pieces are what ranks are given
  /// @param given  null or without cells: this rank has no block
  PieceBlocks(Communicator& communicator, vtkInformation* asked, vtkImageData* given);

  /// Whether the blocks are parts of one grid, and together each of its voxels once. The same on all ranks; if not,
  /// nothing else is to be asked.
  bool MakeUpTheWhole() const { return this->Tiled; }

  const BlockPartition& Partition() const { return this->Blocks; }
  const VoxelBox& Own() const { return this->Blocks.blocks[this->Rank]; }
  bool HasOwn() const { return this->Own().VoxelCount() > 0; }
  /// What the output is to have: the block, and what is asked for of others.
  const VoxelBox& Held() const { return this->OfOutputs[this->Rank]; }
  const std::vector<VoxelBox>& HeldByRanks() const { return this->OfOutputs; }

  /// Whether this rank's own voxels are among those of an image; true where it has none.
  bool HasOwnOf(vtkImageData* image) const;

  /// Of what this rank is given its own voxels, with their arrays; itself where it is no more. Not where it has none.
  vtkSmartPointer<vtkImageData> OwnImage(vtkImageData* given) const;

  /// Of values of each voxel that this rank is given those of its own.
  std::vector<float> OwnOf(vtkImageData* given, std::vector<float>&& values) const;

  /// Crops an output with the arrays of what is given to what the output is to have.
  void KeepHeld(vtkImageData* output) const;

  /// Values of each own voxel become those of each voxel that the output is to have; none stay none, where no rank has
  /// any. All ranks call it.
  /// @param components  of a voxel, the same on all ranks
  void SpreadToHeld(Communicator& communicator, std::vector<float>& values, int components) const;

private:
  std::array<int, 6> ExtentOf(const VoxelBox& box) const;

  int Rank;
  BlockPartition Blocks;
  std::vector<VoxelBox> OfOutputs; ///< by rank
  std::array<int, 3> Base = {};    ///< where the whole begins, in the numbers of extents
  bool Tiled = false, GivenAll = false;
};

/// Blocks that ranks, each with its piece, have agreed to work on.
struct AgreedBlocks
{
  std::unique_ptr<Communicator> communicator;
  std::unique_ptr<PieceBlocks> pieces;
};

/// All ranks that run a filter together call it.
/// @param ranks   null: this process is alone
/// @param wanted  whether this rank would work so: one is enough
/// @return where none would, or pieces make no whole, on all ranks nothing
std::optional<AgreedBlocks> AgreeOnBlocks(
  vtkMultiProcessController* ranks, vtkAlgorithm* filter, bool wanted, vtkInformation* asked, vtkImageData* given);

/// Whether ranks that choose work on pieces of an image: it has more voxels than 64^3. Less each rank has done sooner
/// than ranks say to each other what crosses between them. The environment variable TYNDALL_PIECES_FROM is another
/// number of voxels. A rank that its source tells of no voxels holds none anyway, and leaves it to the others.
bool IsWorthPieces(vtkInformationVector* image);

/// In RequestUpdateExtent or RequestData: whether each rank asks for its piece, and the whole of an image, once for
/// each rank of this machine, does not fit in what it has available now (AvailableMemory.h). Ranks may differ in it.
/// @param image  of the input's port
/// @param bytesOfVoxel  that a rank takes which works on the whole
bool NeedsPieces(
  vtkInformation* request, vtkInformationVector* image, vtkInformationVector* outputs, double bytesOfVoxel);
}
