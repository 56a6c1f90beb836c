#include "Pieces/GatheredImage.h"

#include "Common/Failure.h"
#include "Common/InputsKey.h"
#include "Common/PhaseFunctionData.h"
#include "Device/Errors.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"

#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkMatrix3x3.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int NoPiece = -1;
}

struct PieceValues
{
  ValueBox values;
  std::vector<unsigned char> flags; ///< vtkGhostType of each cell or point; empty: no flags
};

/// Assigns each value (cell or point) of an image to one of its pieces, which may overlap: to the first piece in which
/// vtkGhostType flags the value neither as duplicate nor as hidden, else to the first piece in which it is hidden, else
/// to a piece in which it is a duplicate.
class PieceLayout
{
public:
  /// Assigns the values of the complete image `whole` to the pieces.
  /// @param duplicate, hidden  bits of vtkGhostType that flag a value as duplicate, or as hidden
  PieceLayout(const ValueBox& whole, std::vector<PieceValues> pieces, unsigned char duplicate, unsigned char hidden);

  /// Index of the first value that is in no piece; the number of values if there is no gap.
  std::size_t FirstGap() const;

  /// Index of the piece to which a value is assigned.
  int OwnerOf(std::size_t value) const { return this->Owners[value]; }

  /// vtkGhostType of each value, as in the piece to which the value is assigned.
  std::vector<unsigned char> Flags() const;

  /// Copies those values of a piece that are assigned to it into the array of the complete image.
  /// @param size  size of a value, bytes
  void Paste(int piece, const char* values, std::size_t size, char* whole) const;

  /// Calls act(index in the piece, index in the image) for each value of a piece that is assigned to another piece,
  /// although it is neither duplicate nor hidden in this piece.
  template <typename Do>
  void ForOverlap(int piece, const Do& act) const
  {
    this->ForValues(piece, [&](std::size_t value, std::size_t at) {
      if (this->Owners[at] != piece && !(this->FlagsOf(piece, value) & (this->Duplicate | this->HiddenFlag)))
      {
        act(value, at);
      }
    });
  }

private:
  unsigned char FlagsOf(int piece, std::size_t value) const
  {
    const std::vector<unsigned char>& flags = this->AllPieces[static_cast<std::size_t>(piece)].flags;
    return flags.empty() ? 0 : flags[value];
  }

  template <typename Do>
  void ForValues(int piece, const Do& act) const
  {
    const ValueBox& box = this->AllPieces[static_cast<std::size_t>(piece)].values;
    std::size_t value = 0;
    for (int k = box.low[2]; !box.IsEmpty() && k <= box.high[2]; ++k)
    {
      for (int j = box.low[1]; j <= box.high[1]; ++j)
      {
        std::size_t at = (static_cast<std::size_t>(k - this->Whole.low[2]) * this->Whole.Along(1) +
                           static_cast<std::size_t>(j - this->Whole.low[1])) *
            this->Whole.Along(0) +
          static_cast<std::size_t>(box.low[0] - this->Whole.low[0]);
        for (int i = box.low[0]; i <= box.high[0]; ++i)
        {
          act(value++, at++);
        }
      }
    }
  }

  ValueBox Whole;
  std::vector<PieceValues> AllPieces;
  unsigned char Duplicate, HiddenFlag;
  std::vector<int> Owners;
};

PieceLayout::PieceLayout(
  const ValueBox& whole, std::vector<PieceValues> pieces, unsigned char duplicate, unsigned char hidden)
  : Whole(whole)
  , AllPieces(std::move(pieces))
  , Duplicate(duplicate)
  , HiddenFlag(hidden)
  , Owners(whole.Count(), NoPiece)
{
  const int count = static_cast<int>(this->AllPieces.size());
  const auto take = [&](auto may) {
    for (int piece = 0; piece < count; ++piece)
    {
      this->ForValues(piece, [&](std::size_t value, std::size_t at) {
        if (this->Owners[at] == NoPiece && may(this->FlagsOf(piece, value)))
        {
          this->Owners[at] = piece;
        }
      });
    }
  };
  take([&](unsigned char flags) { return (flags & (duplicate | hidden)) == 0; });
  take([&](unsigned char flags) { return (flags & duplicate) == 0; });
  take([](unsigned char) { return true; });
}

std::size_t PieceLayout::FirstGap() const
{
  return static_cast<std::size_t>(std::find(this->Owners.begin(), this->Owners.end(), NoPiece) - this->Owners.begin());
}

std::vector<unsigned char> PieceLayout::Flags() const
{
  std::vector<unsigned char> flags(this->Owners.size(), 0);
  for (int piece = 0; piece < static_cast<int>(this->AllPieces.size()); ++piece)
  {
    this->ForValues(piece, [&](std::size_t value, std::size_t at) {
      flags[at] = this->Owners[at] == piece ? this->FlagsOf(piece, value) : flags[at];
    });
  }
  return flags;
}

void PieceLayout::Paste(int piece, const char* values, std::size_t size, char* whole) const
{
  this->ForValues(piece, [&](std::size_t value, std::size_t at) {
    if (this->Owners[at] == piece)
    {
      std::memcpy(whole + at * size, values + value * size, size);
    }
  });
}

namespace
{
constexpr int Tag = 745201;                      ///< tag of messages of this class
constexpr vtkIdType LongestMessage = 1073741824; ///< maximum length of a message, bytes: MPI counts in int
constexpr const char* KindNames[] = { "cell", "point" };
using Flags = vtkDataSetAttributes;

/// Size of a tuple of an array, bytes; 0 for types smaller than a byte, which no writer accepts.
vtkIdType TupleSize(vtkDataArray* array)
{
  return static_cast<vtkIdType>(array->GetDataTypeSize()) * array->GetNumberOfComponents();
}

std::vector<unsigned char> FlagsOf(vtkUnsignedCharArray* ghosts)
{
  return ghosts ? std::vector<unsigned char>(ghosts->GetPointer(0), ghosts->GetPointer(0) + ghosts->GetNumberOfTuples())
                : std::vector<unsigned char>();
}

/// Returns `flags` with only the bits of `flag`; empty if these bits are 0 for all values.
std::vector<unsigned char> Only(unsigned char flag, std::vector<unsigned char> flags)
{
  bool any = false;
  for (unsigned char& value : flags)
  {
    value &= flag;
    any = any || value;
  }
  return any ? flags : std::vector<unsigned char>();
}

/// Whether the origins, spacings and directions of two pieces are those of one grid, up to rounding.
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

std::string RanksInWords(int first, int other)
{
  return "ranks " + std::to_string(first) + " and " + std::to_string(other);
}

/// Whether the tuples number `inA` of array `a` and `inB` of array `b` are equal, up to rounding.
bool SameValue(vtkDataArray* a, vtkIdType inA, vtkDataArray* b, vtkIdType inB)
{
  for (int component = 0; component < a->GetNumberOfComponents(); ++component)
  {
    const double x = a->GetComponent(inA, component), y = b->GetComponent(inB, component);
    if (!(std::abs(x - y) <= 1e-5 * std::max(std::abs(x), std::abs(y))) && !(std::isnan(x) && std::isnan(y)))
    {
      return false;
    }
  }
  return true;
}
}

GatheredImage::GatheredImage(vtkMultiProcessController* controller, vtkImageData* piece, Arrays cells, Arrays points,
  On where, const std::string& refusal)
  : Controller(controller)
  , Where(where)
  , Refusal(refusal)
  , Own{ std::move(cells), std::move(points) }
{
  if (controller)
  {
    this->Rank = controller->GetLocalProcessId();
    this->Ranks = controller->GetNumberOfProcesses();
  }
  Piece own;
  OnAllRanks(controller, [&] { own = this->Describe(piece); });
  this->Pieces = this->Ranks == 1 ? std::vector<Piece>{ own } : AllGather(controller, own);
  const int first = this->FirstWithCells();
  if (first == NoPiece)
  {
    return;
  }
  OnAllRanks(controller, [&] { this->CheckPieces(first); });
  for (const Kind kind : { Cells, Points })
  {
    this->Sort(kind, this->Pieces[static_cast<std::size_t>(first)]);
  }
  if (this->Ranks == 1)
  {
    this->Whole = piece;
  }
  else
  {
    this->MakeWhole(first);
    this->ShareFieldData(piece, first);
  }
  this->LayOut(Cells, FlagsOf(own.HasFlags[Cells] ? piece->GetCellGhostArray() : nullptr));
  if (!this->Pieces[static_cast<std::size_t>(first)].Arrays[Points].empty())
  {
    this->LayOut(Points, FlagsOf(own.HasFlags[Points] ? piece->GetPointGhostArray() : nullptr));
  }
}

GatheredImage::~GatheredImage() = default;

void GatheredImage::Refuse(const std::string& why) const
{
  throw InvalidInput(this->Refusal + ": " + why);
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
  own.HasFlags = { piece->GetCellGhostArray() != nullptr, piece->GetPointGhostArray() != nullptr };
  own.Phase = PhaseInWords(piece);
  for (const Kind kind : { Cells, Points })
  {
    const vtkIdType values = kind == Cells ? piece->GetNumberOfCells() : piece->GetNumberOfPoints();
    for (const auto& array : this->Own[kind])
    {
      const std::string name = array->GetName() ? array->GetName() : "";
      own.Arrays[kind].push_back({ name, array->GetDataType(), array->GetNumberOfComponents() });
      Require(array->GetNumberOfTuples() == values,
        "Array \"" + name + "\" has " + std::to_string(array->GetNumberOfTuples()) + " values for " +
          std::to_string(values) + " " + KindNames[kind] + "s. Leave it out.");
    }
  }
  return own;
}

void GatheredImage::ArrayKind::Stream(StreamedMembers& members)
{
  members(this->Name);
  members(this->Type);
  members(this->Components);
}

void GatheredImage::Piece::Stream(StreamedMembers& members)
{
  members(this->Extent);
  members(this->Place);
  members(this->Arrays);
  members(this->HasFlags);
  members(this->Phase);
}

int GatheredImage::FirstWithCells() const
{
  const auto found =
    std::find_if(this->Pieces.begin(), this->Pieces.end(), [](const Piece& piece) { return piece.HasCells(); });
  return found == this->Pieces.end() ? NoPiece : static_cast<int>(found - this->Pieces.begin());
}

void GatheredImage::CheckPieces(int first) const
{
  const Piece& one = this->Pieces[static_cast<std::size_t>(first)];
  for (int rank = first + 1; rank < this->Ranks; ++rank)
  {
    const Piece& other = this->Pieces[static_cast<std::size_t>(rank)];
    if (!other.HasCells())
    {
      continue;
    }
    if (!SamePlace(one.Place, other.Place))
    {
      this->Refuse("its pieces on " + RanksInWords(first, rank) +
        " have different origins, spacings or directions. Resample it to one image.");
    }
    if (one.Phase != other.Phase)
    {
      this->Refuse("field data of its pieces on " + RanksInWords(first, rank) +
        " say different things of the phase function (" + one.Phase + "; " + other.Phase +
        "). Give all ranks the same, or cells 'g'.");
    }
    this->CheckArrays(first, rank, Cells);
    this->CheckArrays(first, rank, Points);
  }
}

void GatheredImage::CheckArrays(int first, int other, Kind kind) const
{
  const auto check = [&](int a, int b) {
    for (const ArrayKind& array : this->Pieces[static_cast<std::size_t>(a)].Arrays[kind])
    {
      const std::vector<ArrayKind>& arrays = this->Pieces[static_cast<std::size_t>(b)].Arrays[kind];
      const auto same =
        std::find_if(arrays.begin(), arrays.end(), [&](const ArrayKind& of) { return of.Name == array.Name; });
      const std::string named = std::string("its ") + KindNames[kind] + " array \"" + array.Name + "\" ";
      if (same == arrays.end())
      {
        this->Refuse(named + "is on rank " + std::to_string(a) + " and not on rank " + std::to_string(b) +
          ". Pass on only arrays that all ranks have.");
      }
      if (same->Type != array.Type || same->Components != array.Components)
      {
        this->Refuse(named + "has other components or another type on " + RanksInWords(a, b) +
          ". Make them the same on all ranks.");
      }
    }
  };
  check(first, other);
  check(other, first);
}

/// Sorts this rank's arrays in the order of the first piece's arrays. Ranks without cells have no arrays.
void GatheredImage::Sort(Kind kind, const Piece& first)
{
  Arrays sorted;
  for (const ArrayKind& array : first.Arrays[kind])
  {
    const auto found = std::find_if(this->Own[kind].begin(), this->Own[kind].end(),
      [&](const auto& own) { return array.Name == (own->GetName() ? own->GetName() : ""); });
    sorted.push_back(found == this->Own[kind].end() ? nullptr : *found);
  }
  this->Own[kind] = std::move(sorted);
}

/// Makes an image without arrays, with the extent of all pieces and the geometry of piece number `first`.
void GatheredImage::MakeWhole(int first)
{
  OnAllRanks(this->Controller, [&] {
    const Piece& one = this->Pieces[static_cast<std::size_t>(first)];
    ValueBox points;
    double cells = 0.0;
    for (const Piece& piece : this->Pieces)
    {
      points.Add(PointBoxOf(piece.Extent));
      cells += static_cast<double>(CellBoxOf(piece.Extent).Count());
    }
    std::array<int, 6> extent = { points.low[0], points.high[0], points.low[1], points.high[1], points.low[2],
      points.high[2] };
    const ValueBox box = CellBoxOf(extent);
    double wanted = 1.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      wanted *= static_cast<double>(box.Along(axis));
    }
    if (cells < wanted)
    {
      this->Refuse("the ranks have fewer cells than its extent. Give each a piece of it.");
    }
    if (this->IsHere())
    {
      this->Whole = vtkSmartPointer<vtkImageData>::New();
      this->Whole->SetExtent(extent.data());
      this->Whole->SetOrigin(one.Place.data());
      this->Whole->SetSpacing(one.Place.data() + 3);
      this->Whole->SetDirectionMatrix(one.Place.data() + 6);
    }
  });
}

/// Gathers the boxes of all pieces and, on ranks that gather the image, the flags of all pieces. Collective.
/// @param own  vtkGhostType of this rank's piece
std::vector<PieceValues> GatheredImage::ShareFlags(Kind kind, const std::vector<unsigned char>& own) const
{
  std::vector<PieceValues> pieces(this->Pieces.size());
  OnAllRanks(this->Controller, [&] {
    for (int rank = 0; rank < this->Ranks; ++rank)
    {
      const Piece& piece = this->Pieces[static_cast<std::size_t>(rank)];
      auto& laid = pieces[static_cast<std::size_t>(rank)];
      laid.values = kind == Cells ? CellBoxOf(piece.Extent) : PointBoxOf(piece.Extent);
      if (this->IsHere() && piece.HasFlags[kind])
      {
        laid.flags.resize(laid.values.Count());
      }
    }
  });
  for (int rank = 0; rank < this->Ranks; ++rank)
  {
    auto& laid = pieces[static_cast<std::size_t>(rank)];
    if (this->Pieces[static_cast<std::size_t>(rank)].HasFlags[kind])
    {
      this->Bring(reinterpret_cast<const char*>(own.data()), reinterpret_cast<char*>(laid.flags.data()),
        static_cast<vtkIdType>(laid.values.Count()), rank);
    }
  }
  return pieces;
}

/// Assigns the cells, or points, of the image to pieces, and finds the hidden ones. Collective.
/// @param own  vtkGhostType of this rank's piece
void GatheredImage::LayOut(Kind kind, const std::vector<unsigned char>& own)
{
  constexpr std::array<unsigned char, Kinds> duplicates = { Flags::DUPLICATECELL, Flags::DUPLICATEPOINT };
  constexpr std::array<unsigned char, Kinds> hiddens = { Flags::HIDDENCELL, Flags::HIDDENPOINT };
  if (this->Ranks == 1)
  {
    this->Hidden[kind] = Only(hiddens[kind], own);
    return;
  }
  std::vector<PieceValues> pieces = this->ShareFlags(kind, own);
  OnAllRanks(this->Controller, [&] {
    if (!this->IsHere())
    {
      return;
    }
    std::array<int, 6> all = {};
    std::copy_n(this->Whole->GetExtent(), 6, all.begin());
    for (std::size_t rank = 0; rank < pieces.size(); ++rank)
    {
      const std::array<int, 6>& extent = this->Pieces[rank].Extent;
      for (int axis = 0; axis < 3; ++axis) // flat pieces of an image that is not flat have no cells
      {
        if (kind == Cells && extent[2 * axis] == extent[2 * axis + 1] && all[2 * axis] < all[2 * axis + 1])
        {
          pieces[rank].values = {};
        }
      }
    }
    const ValueBox whole = kind == Cells ? CellBoxOf(all) : PointBoxOf(all);
    this->Layouts[kind] = std::make_unique<PieceLayout>(whole, std::move(pieces), duplicates[kind], hiddens[kind]);
    if (const std::size_t gap = this->Layouts[kind]->FirstGap(); gap < whole.Count())
    {
      std::string place;
      std::size_t rest = gap;
      for (int axis = 0; axis < 3; rest /= whole.Along(axis), ++axis)
      {
        place += (axis > 0 ? ", " : "") + std::to_string(whole.low[axis] + static_cast<int>(rest % whole.Along(axis)));
      }
      this->Refuse("its pieces leave a gap: no rank has " + std::string(KindNames[kind]) + " (" + place +
        "). Give the ranks pieces of one image.");
    }
    this->Hidden[kind] = Only(hiddens[kind], this->Layouts[kind]->Flags());
  });
}

/// Broadcasts the field data of the piece on rank `from`. Collective.
void GatheredImage::ShareFieldData(vtkImageData* piece, int from)
{
  vtkNew<vtkImageData> carrier; // image without values, to send field data
  carrier->SetDimensions(1, 1, 1);
  if (this->Rank == from)
  {
    carrier->GetFieldData()->ShallowCopy(piece->GetFieldData());
  }
  if (this->Where == On::EveryRank)
  {
    this->Controller->Broadcast(carrier, from);
  }
  else if (from != 0 && this->Rank == from)
  {
    this->Controller->Send(carrier, 0, Tag);
  }
  else if (from != 0 && this->IsFirstRank())
  {
    this->Controller->Receive(carrier, from, Tag);
  }
  if (this->IsHere())
  {
    this->Whole->GetFieldData()->ShallowCopy(carrier->GetFieldData());
  }
}

vtkIdType GatheredImage::CountOf(Kind kind, int rank) const
{
  const std::array<int, 6>& extent = this->Pieces[static_cast<std::size_t>(rank)].Extent;
  return static_cast<vtkIdType>((kind == Cells ? CellBoxOf(extent) : PointBoxOf(extent)).Count());
}

/// Sends an array's bytes from rank `from` to the ranks that gather the image. Collective.
/// @param own     the array's bytes, on rank `from`
/// @param values  receives the bytes, on ranks that gather the image
void GatheredImage::Bring(const char* own, char* values, vtkIdType bytes, int from) const
{
  const bool mine = this->Rank == from;
  if (mine && this->IsHere() && bytes > 0)
  {
    std::memcpy(values, own, static_cast<std::size_t>(bytes));
  }
  for (vtkIdType done = 0; done<bytes&& this->Ranks> 1; done += LongestMessage)
  {
    const vtkIdType length = std::min(LongestMessage, bytes - done);
    if (this->Where == On::EveryRank)
    {
      this->Controller->Broadcast(values + done, length, from);
    }
    else if (from != 0 && mine)
    {
      this->Controller->Send(own + done, length, 0, Tag);
    }
    else if (from != 0 && this->IsFirstRank())
    {
      this->Controller->Receive(values + done, length, from, Tag);
    }
  }
}

vtkSmartPointer<vtkDataArray> GatheredImage::Array(Kind kind, int index)
{
  vtkDataArray* const own = this->Own[kind][static_cast<std::size_t>(index)];
  if (this->Ranks == 1)
  {
    return own;
  }
  vtkSmartPointer<vtkDataArray> whole;
  std::vector<char> buffer;
  vtkIdType size = 0;
  Ending overlap;
  OnAllRanks(this->Controller, [&] {
    const Piece& first = this->Pieces[static_cast<std::size_t>(this->FirstWithCells())];
    const ArrayKind& array = first.Arrays[kind][static_cast<std::size_t>(index)];
    whole = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(array.Type));
    whole->SetName(array.Name.c_str());
    whole->SetNumberOfComponents(array.Components);
    size = TupleSize(whole);
    if (this->IsHere())
    {
      whole->SetNumberOfTuples(kind == Cells ? this->Whole->GetNumberOfCells() : this->Whole->GetNumberOfPoints());
      vtkIdType most = 0;
      for (int rank = 0; rank < this->Ranks; ++rank)
      {
        most = std::max(most, this->CountOf(kind, rank));
      }
      buffer.resize(static_cast<std::size_t>(most * size));
    }
  });
  for (int rank = 0; rank < this->Ranks; ++rank)
  {
    this->Bring(own ? static_cast<const char*>(own->GetVoidPointer(0)) : nullptr, buffer.data(),
      this->CountOf(kind, rank) * size, rank);
    if (this->IsHere())
    {
      this->Layouts[kind]->Paste(
        rank, buffer.data(), static_cast<std::size_t>(size), static_cast<char*>(whole->GetVoidPointer(0)));
    }
    if (this->IsFirstRank() && overlap.kind == Ending::Done)
    {
      overlap = EndingOf([&] { this->CheckOverlap(kind, rank, buffer.data(), whole); });
    }
  }
  OnAllRanks(this->Controller, [&] { Throw(overlap); });
  return this->IsHere() ? whole : nullptr;
}

/// Checks that pieces have equal values where they overlap.
/// @param values  array of the piece on `rank`; pieces of lower ranks are already in `whole`
/// @throws InvalidInput if a value of that piece, neither duplicate nor hidden, differs from the value in the gathered
///   array
void GatheredImage::CheckOverlap(Kind kind, int rank, const char* values, vtkDataArray* whole) const
{
  const auto own = vtkSmartPointer<vtkDataArray>::Take(whole->NewInstance());
  own->SetNumberOfComponents(whole->GetNumberOfComponents());
  own->SetVoidArray(const_cast<char*>(values), this->CountOf(kind, rank) * whole->GetNumberOfComponents(), 1);
  this->Layouts[kind]->ForOverlap(rank, [&](std::size_t value, std::size_t at) {
    if (!SameValue(own, static_cast<vtkIdType>(value), whole, static_cast<vtkIdType>(at)))
    {
      throw InvalidInput(this->Refusal + ": where its pieces on " +
        RanksInWords(this->Layouts[kind]->OwnerOf(at), rank) + " overlap, " + KindNames[kind] + " array \"" +
        whole->GetName() +
        "\" has different values. Mark cells that another rank has, too, as duplicates "
        "(vtkGhostType), or give each rank cells of its own.");
    }
  });
}
}
