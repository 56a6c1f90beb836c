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
/// The subdomains of an image that is distributed among ranks; or the complete image as one subdomain on one rank.
///
/// Each rank has a piece in which ghost cells, owned by its neighbours, are flagged as duplicates (vtkGhostType). If
/// the source does not know about pieces and gives every rank the complete image, a rank's subdomain is the piece of
/// the output that is requested from it.
class PieceBlocks
{
public:
  /// Makes a serial domain: its one subdomain is the complete image, duplicate cells included. Does not check the grid,
  /// which GridOf does.
  explicit PieceBlocks(vtkImageData* whole);
  /// Makes the domain of all ranks, with one subdomain per rank. Collective.
  /// @param asked  information of the output that is made; null: there is no such output, and subdomains are the pieces
  ///   as given
  /// @param given  this rank's piece; null or without cells: this rank has no voxels
  PieceBlocks(Communicator& communicator, vtkInformation* asked, vtkImageData* given);

  /// Whether the subdomains lie on one grid and contain each of its voxels exactly once. The result is the same on all
  /// ranks; if it is false, no other member may be called.
  bool MakeUpTheWhole() const { return this->Tiled; }
  /// Whether the domain is decomposed into pieces of several ranks; otherwise it is serial.
  bool IsDecomposed() const { return !this->OfRanks->IsSerial(); }

  const Domain& GetDomain() const { return *this->OfRanks; }
  const BlockPartition& Partition() const { return this->OfRanks->Partition(); }
  const VoxelBox& Own() const { return this->OfRanks->Own(); }
  bool HasOwn() const { return this->Own().VoxelCount() > 0; }
  /// The voxels of this rank's output: its subdomain and the requested ghost cells.
  const VoxelBox& Held() const { return this->OfOutputs[static_cast<std::size_t>(this->OfRanks->Rank())]; }
  const std::vector<VoxelBox>& HeldByRanks() const { return this->OfOutputs; }

  /// Whether an image contains this rank's subdomain.
  bool HasOwnOf(vtkImageData* image) const;

  /// Crops an image to this rank's subdomain, with its arrays: the image itself if it is the subdomain, or if the
  /// domain is not decomposed; null if the subdomain has no voxels.
  vtkSmartPointer<vtkImageData> OwnImage(vtkImageData* given) const;

  /// Selects the values of the subdomain's voxels from the values of all voxels of an image.
  std::vector<float> OwnOf(vtkImageData* given, std::vector<float>&& values) const;

  /// Crops an output, whose arrays cover the image given to the constructor, to this rank's subdomain and its ghost
  /// cells, Held().
  void KeepHeld(vtkImageData* output) const;

  /// Extends values from the voxels of this rank's subdomain to the voxels of its output, Held(): ghost values are
  /// received from the ranks that own these cells. Values stay empty if they are empty on all ranks. Collective.
  /// @param components  values per voxel, the same on all ranks
  void SpreadToHeld(std::vector<float>& values, int components) const;

private:
  std::array<int, 6> ExtentOf(const VoxelBox& box) const;

  std::shared_ptr<Domain> OfRanks;
  std::vector<VoxelBox> OfOutputs; ///< voxels of each rank's output, ghost cells included (Held), by rank
  std::array<int, 3> Base = {};    ///< VTK index of the grid's first voxel
  bool Tiled = false, GivenAll = false;
};

/// Subdomains on which all ranks have agreed to work.
struct AgreedBlocks
{
  std::unique_ptr<Communicator> communicator;
  std::unique_ptr<PieceBlocks> pieces;
};

/// Decides whether the ranks work on subdomains. Collective.
/// @param wanted  whether this rank would work on its piece; one such rank suffices
/// @return no value, on all ranks, if no rank wants to work on its piece, or if the pieces do not make up one grid
std::optional<AgreedBlocks> AgreeOnBlocks(
  vtkMultiProcessController* ranks, vtkAlgorithm* filter, bool wanted, vtkInformation* asked, vtkImageData* given);

/// Whether an image is large enough to decompose: more than 64^3 voxels, or more than the environment variable
/// TYNDALL_PIECES_FROM says. For smaller images communication costs more than solving the complete image on each rank.
/// True on a rank whose source announces no voxels, so that the other ranks decide.
bool IsWorthPieces(vtkInformationVector* image);

/// Whether the complete image does not fit the available memory of this machine (AvailableMemory.h). The result may
/// differ between ranks.
/// @param bytesOfVoxel  memory that a rank needs per voxel to work on the complete image
bool NeedsPieces(vtkInformationVector* image, double bytesOfVoxel);
}
