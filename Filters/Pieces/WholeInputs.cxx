#include "Pieces/WholeInputs.h"

#include "Common/Failure.h"
#include "Common/ImageInput.h"
#include "Common/InputsKey.h"
#include "Device/Errors.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"

#include "vtkAlgorithm.h"
#include "vtkAppendPolyData.h"
#include "vtkCellData.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <string>
#include <utility>

namespace tyndall
{
namespace
{
using Pipeline = vtkStreamingDemandDrivenPipeline;
using Extent = std::array<int, 6>;

constexpr Extent NoExtent = { 0, -1, 0, -1, 0, -1 };
}

/// Summary of the data that one input connection provides on one rank.
struct InputSummary
{
  bool isThere = false; ///< whether there are data with any values
  bool isImage = false;
  Extent extent = NoExtent;
  Extent whole = NoExtent; ///< whole extent that the source announces
  /// Whether the whole extent depends on time, so that `whole` may belong to another time step.
  bool changes = false;
  std::uint64_t key = 0;             ///< hash of the data's content (ContentKey)
  std::array<std::string, 2> active; ///< names of the active scalars of cells, and of points
  bool aroundPoints = false;         ///< whether voxels are around the image's points
  Extent points = NoExtent;          ///< extent of the points that are not duplicates

  void Stream(StreamedMembers& members)
  {
    members(this->isThere);
    members(this->isImage);
    members(this->extent);
    members(this->whole);
    members(this->changes);
    members(this->key);
    members(this->active);
    members(this->aroundPoints);
    members(this->points);
  }
};

/// Summaries of all input connections on one rank, and the extents that are requested from the rank.
struct RankSummary
{
  std::vector<int> connections; ///< number of connections at each input port
  std::vector<InputSummary> inputs;
  std::vector<Extent> asked; ///< requested extent of each output

  void Stream(StreamedMembers& members)
  {
    members(this->connections);
    members(this->inputs);
    members(this->asked);
  }
};

namespace
{
bool HasValues(vtkDataObject* data)
{
  return data &&
    (data->GetNumberOfElements(vtkDataObject::POINT) > 0 || data->GetNumberOfElements(vtkDataObject::CELL) > 0 ||
      data->GetNumberOfElements(vtkDataObject::ROW) > 0);
}

Extent ExtentIn(vtkInformation* information, vtkInformationIntegerVectorKey* key)
{
  Extent extent = NoExtent;
  if (information->Has(key))
  {
    information->Get(key, extent.data());
  }
  return extent;
}

std::string ActiveName(vtkDataSetAttributes* attributes)
{
  vtkAbstractArray* const active = attributes->GetAbstractAttribute(vtkDataSetAttributes::SCALARS);
  return active && active->GetName() ? active->GetName() : "";
}

/// Summarizes the data of a connection, without the hash `key` of their content.
InputSummary Summarize(vtkInformation* connection)
{
  InputSummary summary;
  vtkDataObject* const data = vtkDataObject::GetData(connection);
  auto* const image = vtkImageData::SafeDownCast(data);
  summary.isImage = image != nullptr;
  summary.whole = ExtentIn(connection, Pipeline::WHOLE_EXTENT());
  summary.changes = connection->Has(Pipeline::TIME_DEPENDENT_INFORMATION()) != 0;
  summary.isThere = image ? image->GetNumberOfCells() > 0 : HasValues(data);
  if (!summary.isThere)
  {
    StopIfUpstreamFailed(data);
    return summary;
  }
  if (image)
  {
    std::copy_n(image->GetExtent(), 6, summary.extent.begin());
    summary.active = { ActiveName(image->GetCellData()), ActiveName(image->GetPointData()) };
  }
  return summary;
}

/// Summaries of one input connection, on each rank.
using OnRanks = std::vector<InputSummary>;

bool Alike(const OnRanks& summaries)
{
  return std::all_of(summaries.begin(), summaries.end(), [&](const InputSummary& summary) {
    return summary.isThere == summaries[0].isThere && summary.key == summaries[0].key &&
      summary.extent == summaries[0].extent;
  });
}

std::string Named(int port)
{
  return "The input" + (port > 0 ? " " + std::to_string(port) : std::string());
}

/// Arrays that can be gathered: numeric, with one tuple for each cell or point, except vtkGhostType.
GatheredImage::Arrays ArraysOf(vtkDataSetAttributes* attributes, vtkIdType values)
{
  GatheredImage::Arrays arrays;
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* const array = attributes->GetArray(i);
    const bool isFlags =
      array && array->GetName() && std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()) == 0;
    if (array && !isFlags && array->GetDataTypeSize() > 0 && array->GetNumberOfTuples() == values)
    {
      arrays.emplace_back(array);
    }
  }
  return arrays;
}

void AddHidden(vtkDataSetAttributes* attributes, const std::vector<unsigned char>* hidden)
{
  if (hidden)
  {
    vtkNew<vtkUnsignedCharArray> flags;
    flags->SetName(vtkDataSetAttributes::GhostArrayName());
    flags->SetNumberOfTuples(static_cast<vtkIdType>(hidden->size()));
    std::copy(hidden->begin(), hidden->end(), flags->GetPointer(0));
    attributes->AddArray(flags);
  }
}

/// Gathers an image from its pieces. Ranks that do not receive the gathered image get their piece. Collective.
vtkSmartPointer<vtkDataObject> WholeImageOf(vtkMultiProcessController* ranks, vtkImageData* piece,
  const OnRanks& summaries, const std::string& named, GatheredImage::On where)
{
  const bool any = piece && piece->GetNumberOfCells() > 0;
  GatheredImage::Arrays cells, points;
  if (any)
  {
    cells = ArraysOf(piece->GetCellData(), piece->GetNumberOfCells());
    points = ArraysOf(piece->GetPointData(), piece->GetNumberOfPoints());
  }
  GatheredImage gathered(ranks, piece, std::move(cells), std::move(points), where,
    named + " lies in pieces on several ranks, which make no whole");
  vtkNew<vtkImageData> unused;
  vtkSmartPointer<vtkImageData> whole = gathered.Frame() ? gathered.Frame() : unused.Get();
  for (int i = 0; i < gathered.NumberOfCellArrays(); ++i)
  {
    whole->GetCellData()->AddArray(gathered.CellArray(i));
  }
  for (int i = 0; i < gathered.NumberOfPointArrays(); ++i)
  {
    whole->GetPointData()->AddArray(gathered.PointArray(i));
  }
  if (!gathered.Frame())
  {
    return piece;
  }
  AddHidden(whole->GetCellData(), gathered.HiddenCells());
  AddHidden(whole->GetPointData(), gathered.HiddenPoints());
  const auto first =
    std::find_if(summaries.begin(), summaries.end(), [](const InputSummary& summary) { return summary.isThere; });
  whole->GetCellData()->SetActiveScalars(first->active[0].c_str());
  whole->GetPointData()->SetActiveScalars(first->active[1].c_str());
  return whole;
}

std::string Words(const Extent& extent)
{
  std::string text;
  for (int i = 0; i < 6; ++i)
  {
    text += (i > 0 ? " " : "") + std::to_string(extent[i]);
  }
  return text;
}

/// Checks that the pieces of an image cover the whole extent, if all ranks announce the same one. They do not if only
/// one rank can read the file: this rank reads only its piece, and the other pieces are missing.
void CheckExtent(const OnRanks& summaries, const std::string& named)
{
  const auto isPiece = [](const InputSummary& summary) { return summary.isThere && summary.isImage; };
  const auto first = std::find_if(summaries.begin(), summaries.end(), isPiece);
  const bool oneExtent = std::all_of(summaries.begin(), summaries.end(),
    [&](const InputSummary& summary) { return !isPiece(summary) || summary.whole == first->whole; });
  if (first == summaries.end() || !oneExtent || PointBoxOf(first->whole).Count() == 0)
  {
    return;
  }
  Extent all = first->extent;
  std::string without;
  std::size_t cells = 0;
  for (std::size_t rank = 0; rank < summaries.size(); ++rank)
  {
    without += isPiece(summaries[rank]) ? "" : (without.empty() ? "" : ", ") + std::to_string(rank);
    cells += isPiece(summaries[rank]) ? CellBoxOf(summaries[rank].extent).Count() : 0;
    for (int i = 0; i < 6 && isPiece(summaries[rank]); ++i)
    {
      all[i] = i % 2 == 0 ? std::min(all[i], summaries[rank].extent[i]) : std::max(all[i], summaries[rank].extent[i]);
    }
  }
  const bool isAll = first->changes && without.empty() && cells > 0 && cells >= CellBoxOf(all).Count();
  Require(all == first->whole || isAll,
    named + " lies in pieces on several ranks, which together have the extent " + Words(all) + " of " +
      Words(first->whole) + ". Give the ranks all pieces." +
      (without.empty() ? ""
                       : " Of ranks " + without +
            " no piece came: a file has to be there for every rank, or where the filter has a Decomposition, set it to "
            "whole on the first rank."));
}

/// Broadcasts data other than images, such as lights, from the one rank that has any. Collective.
vtkSmartPointer<vtkDataObject> FromOneRank(
  vtkMultiProcessController* ranks, vtkDataObject* own, const OnRanks& summaries, const std::string& named)
{
  const auto hasAny = [](const InputSummary& summary) { return summary.isThere; };
  const auto first = std::find_if(summaries.begin(), summaries.end(), hasAny);
  const auto other = std::find_if(first + 1, summaries.end(),
    [&](const InputSummary& summary) { return summary.isThere && summary.key != first->key; });
  Require(other == summaries.end(),
    named + " is different on ranks " + std::to_string(first - summaries.begin()) + " and " +
      std::to_string(other - summaries.begin()) +
      ". Light crosses the borders of pieces, so that every rank needs all of it: give all ranks the same, or one rank "
      "all and the others nothing.");
  const int from = static_cast<int>(first - summaries.begin());
  const bool mine = ranks->GetLocalProcessId() == from;
  const auto all = vtkSmartPointer<vtkDataObject>::Take(own->NewInstance());
  if (mine)
  {
    all->ShallowCopy(own);
  }
  ranks->Broadcast(all, from);
  return all;
}

/// Appends the points of all ranks in the order of ranks; points that are the same on all ranks are used once.
/// Collective.
vtkSmartPointer<vtkDataObject> AllShares(vtkMultiProcessController* ranks, vtkDataObject* own, const OnRanks& summaries)
{
  if (!own || Alike(summaries))
  {
    return own;
  }
  vtkNew<vtkAppendPolyData> all;
  for (int rank = 0; rank < static_cast<int>(summaries.size()); ++rank)
  {
    vtkNew<vtkPolyData> share;
    if (rank == ranks->GetLocalProcessId())
    {
      share->ShallowCopy(own);
    }
    ranks->Broadcast(share, rank);
    if (share->GetNumberOfPoints() > 0)
    {
      all->AddInputData(share);
    }
  }
  all->Update();
  const auto together = vtkSmartPointer<vtkDataObject>::Take(own->NewInstance());
  together->ShallowCopy(all->GetOutput());
  together->SetFieldData(own->GetFieldData());
  return together;
}

vtkSmartPointer<vtkDataObject> WholeOf(vtkMultiProcessController* ranks, vtkDataObject* own, const OnRanks& summaries,
  const std::string& named, GatheredImage::On where)
{
  const bool any =
    std::any_of(summaries.begin(), summaries.end(), [](const InputSummary& summary) { return summary.isThere; });
  if (!any || Alike(summaries))
  {
    return own;
  }
  const bool images = std::any_of(
    summaries.begin(), summaries.end(), [](const InputSummary& summary) { return summary.isThere && summary.isImage; });
  if (!images)
  {
    return FromOneRank(ranks, own, summaries, named);
  }
  CheckExtent(summaries, named);
  return WholeImageOf(ranks, vtkImageData::SafeDownCast(own), summaries, named, where);
}

/// Checks that input images are complete if only one of several ranks updates: the other ranks do not take part, so
/// that missing pieces cannot be gathered.
void RequireAll(vtkAlgorithm* filter, vtkInformationVector** given)
{
  vtkMultiProcessController* const all = vtkMultiProcessController::GetGlobalController();
  for (int port = 0; all && all->GetNumberOfProcesses() > 1 && port < filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < given[port]->GetNumberOfInformationObjects(); ++i)
    {
      const InputSummary summary = Summarize(given[port]->GetInformationObject(i));
      ValueBox both = PointBoxOf(summary.extent);
      both.Add(PointBoxOf(summary.whole));
      Require(!summary.isImage || !summary.isThere || both.Count() == PointBoxOf(summary.extent).Count(),
        Named(port) +
          " has a piece of its image only: its source gives no rank the whole. Ask for pieces on all ranks, as a view "
          "or "
          "UpdatePipeline does, so that they are put together.");
    }
  }
}

/// Smallest extent that contains all points of an image that are no duplicates, by vtkGhostType of points or, if that
/// is missing, of cells.
Extent OwnPointsOf(vtkImageData* image)
{
  Extent extent;
  image->GetExtent(extent.data());
  vtkUnsignedCharArray* const ofPoints = image->GetPointGhostArray();
  vtkUnsignedCharArray* const flags = ofPoints ? ofPoints : image->GetCellGhostArray();
  return flags ? ExtentWithoutDuplicates(extent, flags, ofPoints != nullptr) : extent;
}

/// Makes voxels around the points of a rank's piece. A voxel is a duplicate if this rank does not own its point, or if
/// a lower rank owns the point as well.
vtkSmartPointer<vtkImageData> VoxelsOfPiece(vtkImageData* piece, const OnRanks& summaries, int rank)
{
  const vtkSmartPointer<vtkImageData> voxels = PointsAsVoxels(piece);
  if (Alike(summaries) || std::all_of(summaries.begin(), summaries.end(), [&](const InputSummary& summary) {
        return !summary.isThere || summary.points == summaries[static_cast<std::size_t>(rank)].extent;
      })) // each rank has the complete image, so that no voxel is a duplicate
  {
    return voxels;
  }
  const auto isDuplicate = [&](const std::array<int, 3>& at) {
    bool duplicate = !PointBoxOf(summaries[static_cast<std::size_t>(rank)].points).Holds(at);
    for (int lower = 0; lower < rank && !duplicate; ++lower)
    {
      const InputSummary& other = summaries[static_cast<std::size_t>(lower)];
      duplicate = other.isThere && PointBoxOf(other.points).Holds(at);
    }
    return duplicate;
  };
  const ValueBox box = PointBoxOf(summaries[static_cast<std::size_t>(rank)].extent);
  bool any = false;
  box.ForEach([&](vtkIdType, const std::array<int, 3>& at) { any = any || isDuplicate(at); });
  if (any)
  {
    FlagDuplicates(voxels->GetCellData(), box, vtkDataSetAttributes::DUPLICATECELL, isDuplicate);
  }
  return voxels;
}

RankSummary SummarizeAll(
  vtkAlgorithm* filter, vtkInformationVector** given, vtkInformationVector* outputs, int inShares)
{
  RankSummary rank;
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    rank.connections.push_back(given[port]->GetNumberOfInformationObjects());
    for (int i = 0; i < rank.connections.back(); ++i)
    {
      vtkInformation* const connection = given[port]->GetInformationObject(i);
      rank.inputs.push_back(Summarize(connection));
      vtkDataObject* const data = vtkDataObject::GetData(connection);
      rank.inputs.back().key = port == inShares ? ContentKeyButFacts(data) : ContentKey(data);
      auto* const image = vtkImageData::SafeDownCast(data);
      if (rank.inputs.back().isThere && AreAroundPoints(filter, port, image))
      {
        rank.inputs.back().aroundPoints = true;
        rank.inputs.back().points = OwnPointsOf(image);
      }
    }
  }
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    rank.asked.push_back(ExtentIn(outputs->GetInformationObject(port), Pipeline::UPDATE_EXTENT()));
  }
  return rank;
}

std::vector<RankSummary> Share(vtkMultiProcessController* ranks, const RankSummary& own)
{
  std::vector<RankSummary> all = AllGather(ranks, own);
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    Require(all[rank].connections == all[0].connections,
      "Ranks 0 and " + std::to_string(rank) + " have other inputs connected. Make the same pipeline on all ranks.");
  }
  return all;
}

/// Summaries of connection number `connection` of a port, on each rank.
OnRanks SummariesOf(const std::vector<RankSummary>& all, int port, int connection)
{
  const std::vector<int>& connections = all[0].connections;
  const int before = std::accumulate(connections.begin(), connections.begin() + port, 0);
  OnRanks summaries;
  for (const RankSummary& of : all)
  {
    summaries.push_back(of.inputs[static_cast<std::size_t>(before + connection)]);
  }
  return summaries;
}

/// Extent of the voxels around the points of an extent.
Extent Around(Extent points)
{
  for (int axis = 0; axis < 3 && PointBoxOf(points).Count() > 0; ++axis)
  {
    ++points[2 * axis + 1];
  }
  return points;
}

/// Records which part of each output is requested from each rank, if the parts differ, as with sources that know only
/// their own piece.
void NoteParts(const std::vector<RankSummary>& all, int rank, vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    std::vector<Extent> parts;
    for (const RankSummary& of : all)
    {
      parts.push_back(of.asked[static_cast<std::size_t>(port)]);
      const InputSummary medium = of.inputs.empty() ? InputSummary() : of.inputs.front();
      if (medium.aroundPoints &&
        parts.back() == medium.whole) // `whole` was announced before it was known that voxels are around points
      {
        parts.back() = Around(parts.back());
      }
    }
    const bool alike = std::all_of(parts.begin(), parts.end(), [&](const Extent& part) { return part == parts[0]; });
    NotePartsOfRanks(outputs->GetInformationObject(port), alike ? std::vector<Extent>() : parts, rank);
  }
}
}

struct WholeInputs::Seen
{
  vtkMultiProcessController* ranks;
  int inPieces, inShares;
  std::vector<int> alsoInPieces;
  std::vector<RankSummary> all;
};

WholeInputs::WholeInputs(vtkMultiProcessController* ranks, vtkAlgorithm* filter, vtkInformationVector** given,
  vtkInformationVector* outputs, int inPieces, int inShares, const std::vector<int>& alsoInPieces)
  : Aligned(ranks, filter, given)
  , Kept(this->Aligned.ports.size())
  , Ports(this->Aligned.ports.begin(), this->Aligned.ports.end())
{
  const int ports = static_cast<int>(this->Ports.size());
  std::vector<vtkInformationVector*> aligned = this->Ports;
  if (ranks == nullptr)
  {
    RequireAll(filter, aligned.data());
    NoteParts({}, 0, outputs);
    for (int port = 0; port < ports; ++port)
    {
      this->Change(port, [&](int, vtkDataObject* data) -> vtkSmartPointer<vtkDataObject> {
        auto* const image = vtkImageData::SafeDownCast(data);
        return AreAroundPoints(filter, port, image) ? PointsAsVoxels(image).GetPointer() : data;
      });
    }
    return;
  }
  RankSummary own;
  OnAllRanks(ranks, [&] { own = SummarizeAll(filter, aligned.data(), outputs, inShares); });
  this->AllSeen = std::make_unique<Seen>(Seen{ ranks, inPieces, inShares, alsoInPieces, Share(ranks, own) });
  NoteParts(this->AllSeen->all, ranks->GetLocalProcessId(), outputs);
  for (int port = 0; port < ports; ++port)
  {
    const bool also = std::find(alsoInPieces.begin(), alsoInPieces.end(), port) != alsoInPieces.end();
    if (port != inPieces && port != inShares && !also)
    {
      this->MakeWhole(port, GatheredImage::On::EveryRank);
      continue;
    }
    for (int i = 0; i < this->AllSeen->all[0].connections[static_cast<std::size_t>(port)]; ++i)
    {
      CheckExtent(SummariesOf(this->AllSeen->all, port, i), Named(port));
    }
    this->Change(port, [&](int connection, vtkDataObject* data) -> vtkSmartPointer<vtkDataObject> {
      const OnRanks summaries = SummariesOf(this->AllSeen->all, port, connection);
      const int rank = ranks->GetLocalProcessId();
      return summaries[static_cast<std::size_t>(rank)].aroundPoints
        ? VoxelsOfPiece(vtkImageData::SafeDownCast(data), summaries, rank).GetPointer()
        : data;
    });
  }
}

/// Replaces the data of a port's connections by the results of `change`.
void WholeInputs::Change(int port, const ChangeOfData& change)
{
  const auto number = static_cast<std::size_t>(port);
  vtkSmartPointer<vtkInformationVector>& given = this->Aligned.ports[number];
  this->Kept[number] = WithData(given, change);
  this->Ports[number] = this->Kept[number] ? this->Kept[number] : given;
}

WholeInputs::~WholeInputs() = default;

void WholeInputs::Replace(vtkDataObject* data)
{
  const auto port = static_cast<std::size_t>(this->AllSeen->inPieces);
  vtkNew<vtkInformation> information;
  information->Set(vtkDataObject::DATA_OBJECT(), data);
  this->Kept[port] = vtkSmartPointer<vtkInformationVector>::New();
  this->Kept[port]->Append(information);
  this->Ports[port] = this->Kept[port];
}

void WholeInputs::MakeWhole(GatheredImage::On where)
{
  if (!this->AllSeen)
  {
    return;
  }
  if (this->AllSeen->inPieces != NoPort)
  {
    this->MakeWhole(std::exchange(this->AllSeen->inPieces, NoPort), where);
  }
  if (this->AllSeen->inShares != NoPort)
  {
    this->MakeWhole(this->AllSeen->inShares, where);
  }
  for (const int port : std::exchange(this->AllSeen->alsoInPieces, {}))
  {
    this->MakeWhole(port, where);
  }
}

void WholeInputs::MakeWhole(int port, GatheredImage::On where)
{
  const Seen& seen = *this->AllSeen;
  this->Change(port, [&](int connection, vtkDataObject* data) {
    const OnRanks summaries = SummariesOf(seen.all, port, connection);
    vtkSmartPointer<vtkDataObject> whole = port == seen.inShares
      ? AllShares(seen.ranks, data, summaries)
      : WholeOf(seen.ranks, data, summaries, Named(port), where);
    const bool around =
      std::any_of(summaries.begin(), summaries.end(), [](const InputSummary& summary) { return summary.aroundPoints; });
    auto* const image = vtkImageData::SafeDownCast(whole);
    if (around && image && image->GetNumberOfPoints() > 0)
    {
      whole = PointsAsVoxels(image);
    }
    return whole;
  });
}
}
