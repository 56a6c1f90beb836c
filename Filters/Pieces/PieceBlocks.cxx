#include "Pieces/PieceBlocks.h"

#include "Common/AvailableMemory.h"
#include "Distribution/BoxExchange.h"
#include "Numerics/NumberText.h"
#include "Pieces/ControllerCommunicator.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"

#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace tyndall
{
namespace
{
using Extent = std::array<int, 6>;
constexpr Extent Nothing = { 0, 0, 0, 0, 0, 0 };

/// The piece of the image on one rank.
struct Piece
{
  Extent given = Nothing;
  Extent own = Nothing; ///< extent of the cells that are not duplicates; all 0: there are none
  AskedPiece asked;
  std::array<double, 6> place = {}; ///< origin and spacing
};
constexpr std::size_t WordsOfPiece = 4 * 6 + 6;

std::size_t CellsOf(const Extent& extent)
{
  std::size_t cells = 1;
  for (int axis = 0; axis < 3; ++axis)
  {
    cells *= static_cast<std::size_t>(std::max(0, extent[2 * axis + 1] - extent[2 * axis]));
  }
  return cells;
}

/// Smallest extent that contains all cells of an image except duplicates.
Extent OwnExtentOf(vtkImageData* image, const Extent& all)
{
  vtkUnsignedCharArray* const ghosts = image->GetCellGhostArray();
  const Extent own = ghosts ? ExtentWithoutDuplicates(all, ghosts, false) : all;
  return CellsOf(own) > 0 ? own : Nothing;
}

/// The piece of the output that is requested from this rank. If every rank is asked for the complete image, the image
/// is divided among the ranks nevertheless.
AskedPiece AskedOf(vtkInformation* asked, const Extent& given, int rank, int ranks)
{
  AskedPiece piece = AskedPieceOf(asked, given);
  if (piece.own == given && ranks > 1)
  {
    piece.own = PartOfExtent(given, rank, ranks);
  }
  return piece;
}

Piece PieceOf(vtkInformation* asked, vtkImageData* image, int rank, int ranks)
{
  Piece piece;
  if (image && image->GetNumberOfCells() > 0)
  {
    image->GetExtent(piece.given.data());
    piece.own = OwnExtentOf(image, piece.given);
    std::copy_n(image->GetOrigin(), 3, piece.place.begin());
    std::copy_n(image->GetSpacing(), 3, piece.place.begin() + 3);
    piece.asked = asked ? AskedOf(asked, piece.given, rank, ranks) : AskedPiece{ piece.given, piece.given };
  }
  return piece;
}

/// Array with the extents, origins and spacings of the pieces of all ranks, in which entries of other ranks are 0. The
/// sum of the arrays of all ranks then describes all pieces.
std::vector<double> WordsOf(const Piece& piece, int rank, int ranks)
{
  std::vector<double> words(WordsOfPiece * static_cast<std::size_t>(ranks), 0.0);
  auto to = words.begin() + static_cast<std::ptrdiff_t>(WordsOfPiece) * rank;
  for (const Extent* extent : { &piece.given, &piece.own, &piece.asked.own, &piece.asked.withGhosts })
  {
    to = std::copy(extent->begin(), extent->end(), to);
  }
  std::copy(piece.place.begin(), piece.place.end(), to);
  return words;
}

Piece PieceIn(const double* words)
{
  Piece piece;
  for (Extent* extent : { &piece.given, &piece.own, &piece.asked.own, &piece.asked.withGhosts })
  {
    std::transform(words, words + 6, extent->begin(), [](double word) { return static_cast<int>(word); });
    words += 6;
  }
  std::copy_n(words, 6, piece.place.begin());
  return piece;
}

/// Whether the origins and spacings of two pieces are those of one grid, up to rounding.
bool OfOneGrid(const Piece& a, const Piece& b)
{
  bool same = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double spacing = a.place[3 + axis];
    same = same && std::abs(spacing - b.place[3 + axis]) <= 1e-6 * spacing &&
      std::abs(a.place[axis] - b.place[axis]) <= 1e-6 * (spacing + std::abs(a.place[axis]));
  }
  return same;
}

VoxelBox BoxOf(const Extent& extent, const std::array<int, 3>& base)
{
  VoxelBox box;
  for (int axis = 0; axis < 3 && CellsOf(extent) > 0; ++axis)
  {
    box.first[axis] = extent[2 * axis] - base[axis];
    box.size[axis] = extent[2 * axis + 1] - extent[2 * axis];
  }
  return box;
}

/// Whether the blocks are disjoint and together have as many voxels as the grid.
bool Tile(const BlockPartition& partition)
{
  std::size_t voxels = 0;
  bool apart = true;
  for (std::size_t a = 0; a < partition.blocks.size(); ++a)
  {
    voxels += partition.blocks[a].VoxelCount();
    for (std::size_t b = 0; b < a; ++b)
    {
      apart = apart && Common(partition.blocks[a], partition.blocks[b]).VoxelCount() == 0;
    }
  }
  return apart && voxels == partition.whole.VoxelCount();
}

Grid GridFrom(const Extent& whole, const Piece& piece)
{
  Grid grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.size[axis] = whole[2 * axis + 1] - whole[2 * axis];
    grid.spacing[axis] = piece.place[3 + axis];
    grid.origin[axis] = piece.place[axis] + whole[2 * axis] * piece.place[3 + axis];
  }
  return grid;
}
}

PieceBlocks::PieceBlocks(vtkImageData* whole)
  : Tiled(true)
{
  Grid grid;
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.size[axis] = whole ? std::max(0, whole->GetDimensions()[axis] - 1) : 0;
    grid.spacing[axis] = whole ? whole->GetSpacing()[axis] : 1.0;
    this->Base[axis] = whole ? whole->GetExtent()[2 * axis] : 0;
    grid.origin[axis] = whole ? whole->GetOrigin()[axis] + this->Base[axis] * grid.spacing[axis] : 0.0;
  }
  this->OfRanks = std::make_shared<Domain>(grid);
  this->OfOutputs = this->Partition().blocks;
}

PieceBlocks::PieceBlocks(Communicator& communicator, vtkInformation* asked, vtkImageData* given)
{
  const int rank = communicator.Rank(), ranks = communicator.Ranks();
  const std::vector<double> said = communicator.Sum(WordsOf(PieceOf(asked, given, rank, ranks), rank, ranks));
  std::vector<Piece> pieces;
  for (std::size_t at = 0; at < said.size(); at += WordsOfPiece)
  {
    pieces.push_back(PieceIn(said.data() + at));
  }
  const auto isThere = [](const Piece& piece) { return CellsOf(piece.given) > 0; };
  const auto first = std::find_if(pieces.begin(), pieces.end(), isThere);
  if (first == pieces.end())
  {
    this->OfRanks = std::make_shared<Domain>(communicator, BlockPartition());
    return;
  }
  Extent whole = first->own;
  bool oneGrid = true, alike = true;
  for (const Piece& piece : pieces)
  {
    oneGrid = oneGrid && (!isThere(piece) || OfOneGrid(*first, piece));
    alike = alike && piece.given == first->given && piece.own == piece.given;
    for (int axis = 0; axis < 3 && CellsOf(piece.own) > 0; ++axis)
    {
      whole[2 * axis] = std::min(whole[2 * axis], piece.own[2 * axis]);
      whole[2 * axis + 1] = std::max(whole[2 * axis + 1], piece.own[2 * axis + 1]);
    }
  }
  this->GivenAll = alike && pieces.size() > 1;
  this->Base = { whole[0], whole[2], whole[4] };
  BlockPartition partition;
  partition.whole = GridFrom(whole, *first);
  for (const Piece& piece : pieces)
  {
    partition.blocks.push_back(BoxOf(this->GivenAll ? piece.asked.own : piece.own, this->Base));
    this->OfOutputs.push_back(BoxOf(this->GivenAll ? piece.asked.withGhosts : piece.given, this->Base));
  }
  const VoxelBox all = { { 0, 0, 0 }, partition.whole.size };
  const bool within = std::all_of(this->OfOutputs.begin(), this->OfOutputs.end(),
    [&](const VoxelBox& box) { return Common(box, all).VoxelCount() == box.VoxelCount(); });
  this->Tiled = oneGrid && within && Tile(partition);
  this->OfRanks = std::make_shared<Domain>(communicator, std::move(partition));
}

std::array<int, 6> PieceBlocks::ExtentOf(const VoxelBox& box) const
{
  Extent extent;
  for (int axis = 0; axis < 3; ++axis)
  {
    extent[2 * axis] = box.first[axis] + this->Base[axis];
    extent[2 * axis + 1] = extent[2 * axis] + box.size[axis];
  }
  return extent;
}

bool PieceBlocks::HasOwnOf(vtkImageData* image) const
{
  Extent extent;
  image->GetExtent(extent.data());
  return Common(BoxOf(extent, this->Base), this->Own()).VoxelCount() == this->Own().VoxelCount();
}

vtkSmartPointer<vtkImageData> PieceBlocks::OwnImage(vtkImageData* given) const
{
  if (!this->IsDecomposed())
  {
    return given;
  }
  if (!this->HasOwn() || given->GetNumberOfCells() == static_cast<vtkIdType>(this->Own().VoxelCount()))
  {
    return this->HasOwn() ? given : nullptr;
  }
  const auto own = vtkSmartPointer<vtkImageData>::New();
  own->ShallowCopy(given);
  own->Crop(this->ExtentOf(this->Own()).data());
  return own;
}

std::vector<float> PieceBlocks::OwnOf(vtkImageData* given, std::vector<float>&& values) const
{
  Extent extent;
  given->GetExtent(extent.data());
  const VoxelBox all = BoxOf(extent, this->Base);
  return all.VoxelCount() == this->Own().VoxelCount() ? std::move(values) : PartOf(values, all, this->Own(), 1);
}

void PieceBlocks::KeepHeld(vtkImageData* output) const
{
  if (this->GivenAll)
  {
    KeepPiece(
      this->HasOwn() ? AskedPiece{ this->ExtentOf(this->Held()), this->ExtentOf(this->Own()) } : AskedPiece(), output);
  }
}

void PieceBlocks::SpreadToHeld(std::vector<float>& values, int components) const
{
  Communicator& communicator = this->OfRanks->Comm();
  const auto voxels = [](const std::vector<VoxelBox>& boxes) {
    return std::accumulate(boxes.begin(), boxes.end(), std::size_t{ 0 },
      [](std::size_t sum, const VoxelBox& box) { return sum + box.VoxelCount(); });
  };
  const bool more = voxels(this->OfOutputs) != voxels(this->Partition().blocks);
  if (more && communicator.Largest({ values.empty() ? 0.0 : 1.0 })[0] > 0.0)
  {
    values = ValuesInBox(communicator, this->Partition(), this->OfOutputs, values, components);
  }
}

std::optional<AgreedBlocks> AgreeOnBlocks(
  vtkMultiProcessController* ranks, vtkAlgorithm* filter, bool wanted, vtkInformation* asked, vtkImageData* given)
{
  AgreedBlocks agreed;
  agreed.communicator = CommunicatorOf(ranks, [filter] { return IsStoppedByOthers(filter); });
  if (!OnAnyRank(*agreed.communicator, wanted))
  {
    return {};
  }
  agreed.pieces = std::make_unique<PieceBlocks>(*agreed.communicator, asked, given);
  return agreed.pieces->MakeUpTheWhole() ? std::optional<AgreedBlocks>(std::move(agreed)) : std::nullopt;
}

namespace
{
constexpr double FewVoxels = 64.0 * 64.0 * 64.0;

/// Number of voxels of the whole extent that the source of an image announces.
double VoxelsOf(vtkInformationVector* image)
{
  vtkInformation* const input = image->GetInformationObject(0);
  int whole[6] = { 0, -1, 0, -1, 0, -1 };
  if (input && input->Has(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT()))
  {
    input->Get(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), whole);
  }
  double voxels = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    voxels *= std::max(0, whole[2 * axis + 1] - whole[2 * axis]);
  }
  return voxels;
}
}

bool IsWorthPieces(vtkInformationVector* image)
{
  const char* const said = std::getenv("TYNDALL_PIECES_FROM");
  const double voxels = VoxelsOf(image);
  return voxels == 0.0 || voxels > (said ? NumberIn(said).value_or(0.0) : FewVoxels);
}

bool NeedsPieces(vtkInformationVector* image, double bytesOfVoxel)
{
  return bytesOfVoxel * VoxelsOf(image) > AvailableMemory();
}
}
