#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/Domain.h"
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
/// The subdomains that ranks have of an image, for filters that work on pieces of it; or all of it on one rank.
///
/// Each rank has a piece in which the cells of its neighbours are flagged as duplicates (vtkGhostType). If the source
/// knows no pieces and gives all of the image to each rank, a rank's subdomain is what it is asked for.
class PieceBlocks
{
public:
  /// Serial: the subdomain is all of the image, duplicates as well. Its grid is not checked (GridOf).
  explicit PieceBlocks(vtkImageData* whole);
  /// Collective.
  /// @param asked  the output that is made; null: none is, and subdomains are the pieces
  /// @param given  null or without cells: this rank has no voxels
  PieceBlocks(Communicator& communicator, vtkInformation* asked, vtkImageData* given);

  /// Whether the subdomains belong to one grid and hold each of its voxels once. The same on all ranks; if not, nothing
  /// else may be called.
  bool MakeUpTheWhole() const { return this->Tiled; }
  /// Made of pieces; if not, the domain is serial.
  bool IsDecomposed() const { return this->Decomposed; }

  const Domain& GetDomain() const { return *this->OfRanks; }
  const BlockPartition& Partition() const { return this->OfRanks->Partition(); }
  const VoxelBox& Own() const { return this->OfRanks->Own(); }
  bool HasOwn() const { return this->Own().VoxelCount() > 0; }
  /// The voxels of this rank's output: its subdomain and the ghost cells that are asked for.
  const VoxelBox& Held() const { return this->OfOutputs[static_cast<std::size_t>(this->OfRanks->Rank())]; }
  const std::vector<VoxelBox>& HeldByRanks() const { return this->OfOutputs; }

  /// Whether an image contains this rank's subdomain.
  bool HasOwnOf(vtkImageData* image) const;

  /// The part of an image that is this rank's subdomain, with its arrays; the image itself if that is all of it, or not
  /// decomposed. Only if the rank has voxels.
  vtkSmartPointer<vtkImageData> OwnImage(vtkImageData* given) const;

  /// Values of the subdomain's voxels, out of those of all voxels of an image.
  std::vector<float> OwnOf(vtkImageData* given, std::vector<float>&& values) const;

  /// Crops an output that has the arrays of the given image to Held().
  void KeepHeld(vtkImageData* output) const;

  /// Extends values of Own() to Held(), from the ranks that own the ghost cells; no values stay none if no rank has
  /// any. Collective.
  /// @param components  of a voxel, the same on all ranks
  void SpreadToHeld(Communicator& communicator, std::vector<float>& values, int components) const;

private:
  std::array<int, 6> ExtentOf(const VoxelBox& box) const;

  std::shared_ptr<Domain> OfRanks;
  std::vector<VoxelBox> OfOutputs; ///< by rank
  std::array<int, 3> Base = {};    ///< first voxel of the grid, as extents count
  bool Tiled = false, GivenAll = false, Decomposed = false;
};

/// Subdomains on which ranks have agreed to work.
struct AgreedBlocks
{
  std::unique_ptr<Communicator> communicator;
  std::unique_ptr<PieceBlocks> pieces;
};

/// Collective.
/// @param ranks   null: this process is alone
/// @param wanted  whether this rank would work on its piece; one is enough
/// @return nothing, on all ranks, if none would, or if pieces do not make up one grid
std::optional<AgreedBlocks> AgreeOnBlocks(
  vtkMultiProcessController* ranks, vtkAlgorithm* filter, bool wanted, vtkInformation* asked, vtkImageData* given);

/// Whether an image has enough voxels to be worth decomposing: more than 64^3, or than the variable
/// TYNDALL_PIECES_FROM; below that communication costs more than each rank's solve of all of it. True on a rank whose
/// source announces no voxels, which leaves the decision to the other ranks.
bool IsWorthPieces(vtkInformationVector* image);

/// In RequestUpdateExtent or RequestData: whether each rank asks for its piece, and copies of all of the image for each
/// rank of this machine do not fit its available memory (AvailableMemory.h). Ranks may differ.
/// @param bytesOfVoxel  that a rank needs to work on all of it
bool NeedsPieces(
  vtkInformation* request, vtkInformationVector* image, vtkInformationVector* outputs, double bytesOfVoxel);
}
