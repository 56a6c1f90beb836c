#include "Common/GatheredImage.h"

#include "Device/Errors.h"

#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkMultiProcessController.h"
#include "vtkMultiProcessStream.h"
#include "vtkNew.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <new>

namespace tyndall
{
namespace
{
constexpr int Tag = 745201; ///< of our messages
constexpr int Nobody = -1;

/// The last cell of an extent along an axis; a flat image has one layer.
int LastCell(const std::array<int, 6>& extent, int axis)
{
  return std::max(extent[2 * axis], extent[2 * axis + 1] - 1);
}

vtkIdType CellsAlong(const std::array<int, 6>& extent, int axis)
{
  return static_cast<vtkIdType>(LastCell(extent, axis)) - extent[2 * axis] + 1;
}

/// Bytes of a tuple; 0 for types of less than a byte, which no writer takes.
vtkIdType TupleSize(vtkDataArray* array)
{
  return static_cast<vtkIdType>(array->GetDataTypeSize()) * array->GetNumberOfComponents();
}

std::vector<unsigned char> GhostsOf(vtkImageData* piece)
{
  auto* ghosts = piece->GetCellGhostArray();
  return ghosts ? std::vector<unsigned char>(ghosts->GetPointer(0), ghosts->GetPointer(0) + ghosts->GetNumberOfTuples())
                : std::vector<unsigned char>();
}

/// Whether two pieces are parts of one lattice, to rounding.
bool SamePlace(const std::array<double, 15>& a, const std::array<double, 15>& b)
{
  for (int i = 0; i < 15; ++i)
  {
    const double size = i < 3 ? a[3 + i] + 1e-6 * std::abs(a[i]) : i < 6 ? a[i] : 1.0;
    if (!(std::abs(a[i] - b[i]) <= 1e-6 * size))
    {
      return false;
    }
  }
  return true;
}
}

void OnAllRanks(vtkMultiProcessController* controller, const std::function<void()>& act)
{
  std::string failure;
  try
  {
    act();
  }
  catch (const std::bad_alloc&)
  {
    failure = "The machine's memory does not suffice to write the image. Write fewer arrays at a time.";
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  if (controller && controller->GetNumberOfProcesses() > 1)
  {
    const int length = static_cast<int>(failure.size());
    std::vector<int> lengths(static_cast<std::size_t>(controller->GetNumberOfProcesses()));
    controller->AllGather(&length, lengths.data(), 1);
    const auto failed = std::find_if(lengths.begin(), lengths.end(), [](int of) { return of > 0; });
    failure.resize(failed == lengths.end() ? 0 : static_cast<std::size_t>(*failed));
    if (!failure.empty())
    {
      controller->Broadcast(&failure[0], *failed, static_cast<int>(failed - lengths.begin()));
    }
  }
  if (!failure.empty())
  {
    throw InvalidInput(failure);
  }
}

vtkIdType GatheredImage::Piece::Count() const
{
  return this->HasCells() ? CellsAlong(this->Extent, 0) * CellsAlong(this->Extent, 1) * CellsAlong(this->Extent, 2) : 0;
}

GatheredImage::GatheredImage(
  vtkMultiProcessController* controller, vtkImageData* piece, std::vector<vtkSmartPointer<vtkDataArray>> cells)
  : Controller(controller)
  , Arrays(std::move(cells))
{
  if (controller)
  {
    this->Rank = controller->GetLocalProcessId();
    this->Ranks = controller->GetNumberOfProcesses();
  }
  Piece own;
  OnAllRanks(controller, [&] { own = this->Describe(piece); });
  if (this->Ranks == 1)
  {
    this->Whole = own.HasCells() ? piece : nullptr;
    this->HiddenCells = std::move(own.Ghosts);
  }
  else
  {
    this->GatherPieces(own);
    this->PutTogether(piece);
  }
  bool any = false;
  for (unsigned char& flags : this->HiddenCells)
  {
    flags &= vtkDataSetAttributes::HIDDENCELL;
    any = any || flags;
  }
  if (!any)
  {
    this->HiddenCells.clear();
  }
}

GatheredImage::Piece GatheredImage::Describe(vtkImageData* piece) const
{
  Piece own;
  if (piece == nullptr || piece->GetNumberOfCells() == 0)
  {
    return own;
  }
  std::copy_n(piece->GetExtent(), 6, own.Extent.begin());
  std::copy_n(piece->GetOrigin(), 3, own.Place.begin());
  std::copy_n(piece->GetSpacing(), 3, own.Place.begin() + 3);
  std::copy_n(piece->GetDirectionMatrix()->GetData(), 9, own.Place.begin() + 6);
  own.Ghosts = GhostsOf(piece);
  for (const auto& array : this->Arrays)
  {
    const std::string name = array->GetName() ? array->GetName() : "";
    own.Arrays.push_back({ name, array->GetDataType(), array->GetNumberOfComponents() });
    if (array->GetNumberOfTuples() != piece->GetNumberOfCells())
    {
      throw InvalidInput("Array \"" + name + "\" has " + std::to_string(array->GetNumberOfTuples()) + " values for " +
        std::to_string(piece->GetNumberOfCells()) + " cells. Leave it out.");
    }
  }
  return own;
}

/// Brings the description of each piece to the first rank.
void GatheredImage::GatherPieces(const Piece& own)
{
  vtkMultiProcessStream stream;
  std::for_each(own.Extent.begin(), own.Extent.end(), [&](int bound) { stream << bound; });
  std::for_each(own.Place.begin(), own.Place.end(), [&](double number) { stream << number; });
  stream << static_cast<int>(own.Arrays.size());
  for (const ArrayKind& array : own.Arrays)
  {
    stream << array.Name << array.Type << array.Components;
  }
  stream << static_cast<int>(!own.Ghosts.empty());
  std::vector<vtkMultiProcessStream> streams;
  this->Controller->Gather(stream, streams, 0);
  if (!this->IsFirstRank())
  {
    if (!own.Ghosts.empty())
    {
      this->Controller->Send(own.Ghosts.data(), static_cast<vtkIdType>(own.Ghosts.size()), 0, Tag);
    }
    return;
  }
  for (int rank = 0; rank < this->Ranks; ++rank)
  {
    this->Pieces.push_back(this->Receive(streams[static_cast<std::size_t>(rank)], rank, own));
  }
}

GatheredImage::Piece GatheredImage::Receive(vtkMultiProcessStream& stream, int rank, const Piece& own) const
{
  Piece piece;
  int arrays = 0, hasGhosts = 0;
  std::for_each(piece.Extent.begin(), piece.Extent.end(), [&](int& bound) { stream >> bound; });
  std::for_each(piece.Place.begin(), piece.Place.end(), [&](double& number) { stream >> number; });
  stream >> arrays;
  piece.Arrays.resize(static_cast<std::size_t>(arrays));
  for (ArrayKind& array : piece.Arrays)
  {
    stream >> array.Name >> array.Type >> array.Components;
  }
  stream >> hasGhosts;
  if (rank == 0)
  {
    piece.Ghosts = own.Ghosts;
  }
  else if (hasGhosts)
  {
    piece.Ghosts.resize(static_cast<std::size_t>(piece.Count()));
    this->Controller->Receive(piece.Ghosts.data(), piece.Count(), rank, Tag);
  }
  return piece;
}

/// Agrees on what the whole is.
void GatheredImage::PutTogether(vtkImageData* piece)
{
  int first = Nobody;
  OnAllRanks(this->Controller, [&] {
    if (this->IsFirstRank() && (first = this->FirstWithCells()) != Nobody)
    {
      this->CheckPieces(first);
      this->MakeWhole(first);
      this->FindOwners();
    }
  });
  this->Controller->Broadcast(&first, 1, 0);
  if (first == Nobody)
  {
    this->Arrays.clear();
    return;
  }
  int arrays = static_cast<int>(this->Arrays.size());
  this->Controller->Broadcast(&arrays, 1, first);
  this->Arrays.resize(static_cast<std::size_t>(arrays)); // ranks without cells have none
  this->GatherFieldData(piece, first);
}

int GatheredImage::FirstWithCells() const
{
  const auto found =
    std::find_if(this->Pieces.begin(), this->Pieces.end(), [](const Piece& piece) { return piece.HasCells(); });
  return found == this->Pieces.end() ? Nobody : static_cast<int>(found - this->Pieces.begin());
}

void GatheredImage::CheckPieces(int first) const
{
  for (int rank = first + 1; first != Nobody && rank < this->Ranks; ++rank)
  {
    const Piece& one = this->Pieces[static_cast<std::size_t>(first)];
    const Piece& other = this->Pieces[static_cast<std::size_t>(rank)];
    const std::string ranks = "ranks " + std::to_string(first) + " and " + std::to_string(rank);
    if (!other.HasCells())
    {
      continue;
    }
    if (!SamePlace(one.Place, other.Place))
    {
      throw InvalidInput("The image is not written: its pieces on " + ranks +
        " have different origins, spacings or directions. Resample it to one image.");
    }
    if (!std::equal(one.Arrays.begin(), one.Arrays.end(), other.Arrays.begin(), other.Arrays.end()))
    {
      throw InvalidInput("The image is not written: its pieces on " + ranks +
        " have different arrays, or in a different order. Pass on only those that all have.");
    }
  }
}

/// The extent of all pieces, where the first of them lies.
void GatheredImage::MakeWhole(int first)
{
  const Piece& one = this->Pieces[static_cast<std::size_t>(first)];
  std::array<int, 6> extent = one.Extent;
  double cells = 0.0;
  for (const Piece& piece : this->Pieces)
  {
    for (int axis = 0; piece.HasCells() && axis < 3; ++axis)
    {
      extent[2 * axis] = std::min(extent[2 * axis], piece.Extent[2 * axis]);
      extent[2 * axis + 1] = std::max(extent[2 * axis + 1], piece.Extent[2 * axis + 1]);
    }
    cells += static_cast<double>(piece.Count());
  }
  double wanted = 1.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    wanted *= static_cast<double>(CellsAlong(extent, axis));
  }
  if (cells < wanted)
  {
    throw InvalidInput(
      "The image is not written: the ranks have fewer cells than its extent. Give each a piece of it.");
  }
  this->Whole = vtkSmartPointer<vtkImageData>::New();
  this->Whole->SetExtent(extent.data());
  this->Whole->SetOrigin(one.Place.data());
  this->Whole->SetSpacing(one.Place.data() + 3);
  this->Whole->SetDirectionMatrix(one.Place.data() + 6);
}

/// Calls act with the number of each of a piece's cells in the piece, and in the whole. A piece without thickness has
/// none where the whole has some.
template <typename Do>
void GatheredImage::ForCells(const Piece& piece, const Do& act) const
{
  std::array<int, 6> all = {};
  std::copy_n(this->Whole->GetExtent(), 6, all.begin());
  for (int axis = 0; axis < 3; ++axis)
  {
    if (!piece.HasCells() ||
      (piece.Extent[2 * axis] == piece.Extent[2 * axis + 1] && all[2 * axis] < all[2 * axis + 1]))
    {
      return;
    }
  }
  vtkIdType cell = 0;
  for (int k = piece.Extent[4]; k <= LastCell(piece.Extent, 2); ++k)
  {
    for (int j = piece.Extent[2]; j <= LastCell(piece.Extent, 1); ++j)
    {
      vtkIdType at = ((static_cast<vtkIdType>(k) - all[4]) * CellsAlong(all, 1) + j - all[2]) * CellsAlong(all, 0) +
        piece.Extent[0] - all[0];
      for (int i = piece.Extent[0]; i <= LastCell(piece.Extent, 0); ++i)
      {
        act(static_cast<std::size_t>(cell++), static_cast<std::size_t>(at++));
      }
    }
  }
}

void GatheredImage::FindOwners()
{
  const auto count = static_cast<std::size_t>(this->Whole->GetNumberOfCells());
  this->Owners.assign(count, Nobody);
  this->HiddenCells.assign(count, 0);
  for (bool duplicates : { false, true }) // those that no rank has as its own come from one that has a copy
  {
    for (int rank = 0; rank < this->Ranks; ++rank)
    {
      const Piece& piece = this->Pieces[static_cast<std::size_t>(rank)];
      this->ForCells(piece, [&](std::size_t cell, std::size_t at) {
        const unsigned char flags = piece.Ghosts.empty() ? 0 : piece.Ghosts[cell];
        if (this->Owners[at] == Nobody && (duplicates || !(flags & vtkDataSetAttributes::DUPLICATECELL)))
        {
          this->Owners[at] = rank;
          this->HiddenCells[at] = flags;
        }
      });
    }
  }
  if (std::find(this->Owners.begin(), this->Owners.end(), Nobody) != this->Owners.end())
  {
    throw InvalidInput("The image is not written: its pieces leave a gap. Give the ranks pieces of one image.");
  }
}

/// Field data are those of the first piece.
void GatheredImage::GatherFieldData(vtkImageData* piece, int from)
{
  vtkNew<vtkImageData> carrier; // of field data only
  carrier->SetDimensions(1, 1, 1);
  if (this->Rank == from)
  {
    carrier->GetFieldData()->ShallowCopy(piece->GetFieldData());
  }
  if (from != 0 && this->Rank == from)
  {
    this->Controller->Send(carrier, 0, Tag);
  }
  if (this->IsFirstRank())
  {
    if (from != 0)
    {
      this->Controller->Receive(carrier, from, Tag);
    }
    this->Whole->GetFieldData()->ShallowCopy(carrier->GetFieldData());
  }
}

/// Room for the whole of an array.
vtkSmartPointer<vtkDataArray> GatheredImage::NewArray(const ArrayKind& kind) const
{
  auto whole = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(kind.Type));
  whole->SetName(kind.Name.c_str());
  whole->SetNumberOfComponents(kind.Components);
  whole->SetNumberOfTuples(this->Whole->GetNumberOfCells());
  return whole;
}

/// Copies what a rank owns from the values of its piece.
void GatheredImage::Paste(int rank, const char* values, vtkDataArray* whole) const
{
  const auto size = static_cast<std::size_t>(TupleSize(whole));
  char* const to = static_cast<char*>(whole->GetVoidPointer(0));
  this->ForCells(this->Pieces[static_cast<std::size_t>(rank)], [&](std::size_t cell, std::size_t at) {
    if (this->Owners[at] == rank)
    {
      std::memcpy(to + at * size, values + cell * size, size);
    }
  });
}

vtkSmartPointer<vtkDataArray> GatheredImage::Array(int index)
{
  vtkDataArray* own = this->Arrays[static_cast<std::size_t>(index)];
  if (this->Ranks == 1)
  {
    return own;
  }
  vtkSmartPointer<vtkDataArray> whole;
  std::vector<char> buffer;
  OnAllRanks(this->Controller, [&] {
    if (this->IsFirstRank())
    {
      const Piece& first = this->Pieces[static_cast<std::size_t>(this->FirstWithCells())];
      whole = this->NewArray(first.Arrays[static_cast<std::size_t>(index)]);
      vtkIdType most = 0;
      std::for_each(
        this->Pieces.begin(), this->Pieces.end(), [&](const Piece& piece) { most = std::max(most, piece.Count()); });
      buffer.resize(static_cast<std::size_t>(most * TupleSize(whole)));
    }
  });
  const char* const values = own ? static_cast<const char*>(own->GetVoidPointer(0)) : nullptr;
  if (!this->IsFirstRank())
  {
    if (own && TupleSize(own) > 0)
    {
      this->Controller->Send(values, own->GetNumberOfTuples() * TupleSize(own), 0, Tag);
    }
    return nullptr;
  }
  for (int rank = 0; rank < this->Ranks; ++rank)
  {
    const vtkIdType bytes = this->Pieces[static_cast<std::size_t>(rank)].Count() * TupleSize(whole);
    if (rank > 0 && bytes > 0)
    {
      this->Controller->Receive(buffer.data(), bytes, rank, Tag);
    }
    this->Paste(rank, rank > 0 ? buffer.data() : values, whole);
  }
  return whole;
}
}
