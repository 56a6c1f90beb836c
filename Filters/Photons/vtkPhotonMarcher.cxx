#include "vtkPhotonMarcher.h"

#include "Common/DeviceBudget.h"
#include "Common/ImageInput.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Device/Device.h"
#include "Distribution/SharedMedium.h"
#include "Numerics/ChooseEvenly.h"
#include "Photons/Marching/PhotonPacking.h"
#include "Photons/PhotonData.h"
#include "Photons/Published/PublishedPhotons.h"
#include "Photons/RefractiveInput.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/PieceBlocks.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"

#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace
{
enum InputPort
{
  MediumPort,
  PhotonsPort,
  OctreePort,
  InputPortCount
};

/// Whether light in empty space is to be stored by bricks. The light is correct even if a filter has changed the medium
/// since it was read: the file's `active_part` only selects the storage of light.
bool ByBricks(vtkPhotonMarcher* filter, vtkImageData* medium)
{
  constexpr double mostActive = 0.25;
  const bool sparse = medium && tyndall::ReadFact(medium, tyndall::ActivePartFact, 1.0) <= mostActive;
  return filter->GetEmptySpace() == vtkPhotonMarcher::BY_BRICK ||
    (filter->GetEmptySpace() == vtkPhotonMarcher::AS_READ && sparse);
}

/// Memory per voxel of a rank that marches through the whole medium: the medium's arrays, spline of the index, sums and
/// light.
constexpr double BytesOfVoxel = 96.0;

bool IsOfLaterBatch(const tyndall::Photon& photon)
{
  return photon.batch > 0;
}

/// @param medium  null if this rank has no piece of it
/// @param batches  whether there are several batches of photons
tyndall::MarchSettings SettingsOf(vtkPhotonMarcher* filter, vtkImageData* medium, bool batches)
{
  const bool published = filter->GetScheme() == vtkPhotonMarcher::PUBLISHED;
  if (published && filter->GetMaximumOrders() != 1)
  {
    throw tyndall::InvalidInput("The published scheme follows photons to where they are first scattered. Choose the "
                                "conservative scheme (Scheme 1), or MaximumOrders 1.");
  }
  if (published && filter->GetPhotonCounts())
  {
    throw tyndall::InvalidInput(
      "The published scheme packs all that it keeps of a voxel into 64 bits, and does not count "
      "photons. Choose the conservative scheme (Scheme 1), or switch PhotonCounts off.");
  }
  tyndall::MarchSettings settings;
  settings.order = published ? 1 : filter->GetIntegratorOrder();
  settings.stepSize = published ? 1.0 : filter->GetStepSize();
  settings.counts = filter->GetPhotonCounts();
  settings.leaveOut = filter->GetLeaveOut();
  settings.byBricks = !published && ByBricks(filter, medium);
  settings.maximumOrders = published ? 1 : filter->GetMaximumOrders();
  settings.seed = static_cast<std::uint64_t>(filter->GetSeed());
  if (settings.maximumOrders != 1)
  {
    settings.errorBatches = settings.counts ? 0 : filter->GetErrorBatches();
    return settings;
  }
  settings.batches = !published && batches;
  return settings;
}

tyndall::PublishedSettings PublishedSettingsOf(vtkPhotonMarcher* filter)
{
  tyndall::PublishedSettings settings;
  settings.smooth = filter->GetSmoothing();
  return settings;
}

/// Extends the light of a rank's block to all voxels of the output, ghost cells included. Collective.
void SpreadToHeld(
  tyndall::Communicator& communicator, const tyndall::PieceBlocks& pieces, tyndall::PhotonLight& photons)
{
  pieces.SpreadToHeld(communicator, photons.light.fluence, photons.light.channels);
  pieces.SpreadToHeld(communicator, photons.light.fluenceDirect, photons.light.channels);
  pieces.SpreadToHeld(communicator, photons.light.fluenceError, photons.light.channels);
  pieces.SpreadToHeld(communicator, photons.batchFluence, photons.light.channels * photons.batches);
  pieces.SpreadToHeld(communicator, photons.meanDirection, 3);
  pieces.SpreadToHeld(communicator, photons.photonCount, 1);
  pieces.SpreadToHeld(communicator, photons.photonWeight, 1);
}

void WriteLightOf(tyndall::PhotonLight&& photons, vtkImageData* output)
{
  const int channels = photons.light.channels;
  const bool scattered = photons.scatterings > 0;
  const bool direct = photons.light.fluenceDirect.empty(); // none of it was scattered
  tyndall::WriteLight(std::move(photons.light), output);
  if (direct)
  {
    tyndall::AddSameLight(output, "fluence_direct", "fluence");
  }
  tyndall::AddCells(output, "mean_direction", std::move(photons.meanDirection), 3);
  if (!photons.photonCount.empty())
  {
    tyndall::AddCells(output, "photon_count", std::move(photons.photonCount), 1);
    tyndall::AddCells(output, "photon_weight", std::move(photons.photonWeight), 1);
  }
  if (!photons.batchFluence.empty())
  {
    tyndall::AddCells(output, "fluence_batches", std::move(photons.batchFluence), photons.batches * channels);
  }
  if (scattered)
  {
    tyndall::AddFact(output, tyndall::ScatteringsFact, std::vector<double>{ static_cast<double>(photons.scatterings) });
    tyndall::AddFact(
      output, "exchanged", { photons.exchanged.begin(), photons.exchanged.begin() + channels }, channels);
  }
  tyndall::AddFact(output, "scattered", { photons.scattered.begin(), photons.scattered.begin() + channels }, channels);
}
}

/// Input of a rank's march: its piece of the medium and its photons.
struct vtkPhotonMarcher::PieceOfMarch
{
  vtkSmartPointer<vtkImageData> image; ///< owns the medium's arrays; null if this rank has no piece of it
  tyndall::RefractiveInput read;
  bool octreeElsewhere = false; ///< the octree's piece has other voxels than the medium's
  tyndall::MarchSettings settings;
  bool emits = false;                   ///< whether this rank's piece of the medium emits
  std::vector<tyndall::Photon> photons; ///< this rank's share of the photons
};

/// Result of a march: light, the published scheme's packing loss, and paths by the conservative scheme's integrator.
struct vtkPhotonMarcher::Marched
{
  tyndall::PhotonLight light;
  double packingLoss = 0.0;
  std::vector<tyndall::PhotonPath> paths;
};

vtkStandardNewMacro(vtkPhotonMarcher);

vtkPhotonMarcher::vtkPhotonMarcher()
  : Kept(std::make_unique<tyndall::KeptMarcher>())
{
  const tyndall::MarchSettings defaults;
  this->IntegratorOrder = defaults.order;
  this->StepSize = defaults.stepSize;
  this->PhotonCounts = defaults.counts;
  this->LeaveOut = defaults.leaveOut;
  this->MaximumOrders = defaults.maximumOrders;
  this->SetNumberOfInputPorts(InputPortCount);
  this->SetNumberOfOutputPorts(2);
}

vtkPhotonMarcher::~vtkPhotonMarcher() = default;

void vtkPhotonMarcher::SetPhotonsConnection(vtkAlgorithmOutput* photons)
{
  this->SetInputConnection(PhotonsPort, photons);
}

void vtkPhotonMarcher::SetPhotonsData(vtkDataObject* photons)
{
  this->SetInputDataObject(PhotonsPort, photons);
}

void vtkPhotonMarcher::SetOctreeConnection(vtkAlgorithmOutput* octree)
{
  this->SetInputConnection(OctreePort, octree);
}

void vtkPhotonMarcher::SetOctreeData(vtkDataObject* octree)
{
  this->SetInputDataObject(OctreePort, octree);
}

void vtkPhotonMarcher::RemoveOctree()
{
  this->SetInputConnection(OctreePort, nullptr);
}

int vtkPhotonMarcher::FillInputPortInformation(int port, vtkInformation* information)
{
  if (port == PhotonsPort)
  {
    information->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  }
  else
  {
    tyndall::TakeImages(information);
  }
  if (port == MediumPort)
  {
    tyndall::ReadsVoxels(information, { "sigma_a", "sigma_s", "emission", "ior" }, { "g" });
  }
  if (port == OctreePort)
  {
    tyndall::ReadsVoxels(information, {}, { "octree_level" });
    information->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

vtkTypeBool vtkPhotonMarcher::ProcessRequest(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::WarnOfBlocks(this, request, inputs);
  return this->Superclass::ProcessRequest(request, inputs, outputs);
}

int vtkPhotonMarcher::FillOutputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkPolyData");
  return 1;
}

void vtkPhotonMarcher::SetInputConnection(int port, vtkAlgorithmOutput* input)
{
  if (port != PhotonsPort && input != this->GetInputConnection(port, 0))
  {
    this->Kept->Forget();
  }
  this->Superclass::SetInputConnection(port, input);
}

int vtkPhotonMarcher::RequestInformation(vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  tyndall::TellVoxels(this, MediumPort, inputs[MediumPort], outputs);
  return 1;
}

/// Whether this rank can use a decomposition, as far as is known without reading the medium.
bool vtkPhotonMarcher::WantsBlocks(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) const
{
  return this->Decomposition == AUTOMATIC_DECOMPOSITION
    ? tyndall::EachAsksForItsPiece(request, outputs) && tyndall::IsWorthPieces(inputs[MediumPort])
    : this->Decomposition == BLOCKS;
}

/// Frees the device memory of an old medium before upstream filters run, which may need it.
int vtkPhotonMarcher::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Kept->ForgetIfRan(this, { MediumPort, OctreePort });
  const bool asPiece = tyndall::EachAsksForItsPiece(request, outputs) && this->WantsBlocks(request, inputs, outputs);
  for (int port = 0; port < InputPortCount; ++port)
  {
    const auto ask = asPiece ? tyndall::AskForSame : tyndall::AskForAll;
    ask(request, inputs[port], outputs);
  }
  return 1;
}

namespace
{
/// The part of an octree's image with exactly the voxels of a piece of the medium; null if there is none.
vtkSmartPointer<vtkImageData> OctreeOf(const tyndall::PieceBlocks& pieces, vtkImageData* octree, vtkImageData* medium)
{
  if (octree->GetNumberOfCells() == 0)
  {
    return nullptr;
  }
  const vtkSmartPointer<vtkImageData> own = pieces.OwnImage(octree);
  return tyndall::AreSameVoxels(tyndall::GridOf(own), tyndall::GridOf(medium)) ? own : nullptr;
}

/// Whether any rank has photons of several batches. Collective.
bool HaveBatches(tyndall::Communicator& communicator, const std::vector<tyndall::Photon>& photons)
{
  const bool own = std::any_of(photons.begin(), photons.end(), IsOfLaterBatch);
  return tyndall::OnAnyRank(communicator, own);
}
}

/// Reads this rank's piece of the medium and share of the photons. Collective.
/// @return false, on all ranks, if photons cannot be marched through pieces, or a march through the whole is preferred
bool vtkPhotonMarcher::ReadPiece(tyndall::Communicator& communicator, const tyndall::PieceBlocks& pieces,
  vtkInformationVector** inputs, bool needsPieces, PieceOfMarch& piece)
{
  bool rather = false; // march through the whole is preferred, though pieces are possible
  std::vector<tyndall::Photon> photons =
    tyndall::ShareOfPhotons(communicator, vtkPolyData::GetData(inputs[PhotonsPort]), tyndall::OwnAxesOf(this));
  const bool batches = HaveBatches(communicator, photons);
  communicator.Collective([&] {
    piece.photons = std::move(photons);
    if (pieces.HasOwn())
    {
      piece.image = pieces.OwnImage(vtkImageData::GetData(inputs[MediumPort]));
      vtkImageData* const given = vtkImageData::GetData(inputs[OctreePort]);
      const vtkSmartPointer<vtkImageData> octree = given ? OctreeOf(pieces, given, piece.image) : nullptr;
      piece.octreeElsewhere = given && !octree;
      piece.read = tyndall::ReadRefractiveMedium(this, piece.image, octree);
    }
    piece.emits = piece.read.input.Emits();
    piece.settings = SettingsOf(this, piece.image, batches);
    rather = this->Decomposition == AUTOMATIC_DECOMPOSITION && piece.settings.byBricks && !needsPieces;
    tyndall::Require(!piece.octreeElsewhere || this->Decomposition != BLOCKS,
      "Ranks cannot march photons through their pieces (Decomposition: blocks) with an octree that lies in other "
      "pieces on ranks than the medium. Leave it out, or let each rank have the whole.");
  });
  tyndall::MediumInput& input = piece.read.input;
  tyndall::AgreeOnMeanCosine(communicator, pieces.HasOwn(), input.g, input.medium);
  return !tyndall::OnAnyRank(communicator, piece.octreeElsewhere || rather);
}

/// Marches photons by the published scheme. Collective.
void vtkPhotonMarcher::MarchAsPublished(tyndall::Device& device, const tyndall::Domain& domain,
  const tyndall::RefractiveInput& read, const std::vector<tyndall::Photon>& photons, Marched& marched)
{
  tyndall::PackingLoss loss;
  marched.light = tyndall::MarchPublished(device, domain, read.input.medium, read.ior, read.Levels(), photons,
    PublishedSettingsOf(this), &loss, tyndall::MonitorOf(this));
  marched.packingLoss = loss.Relative();
}

/// Marches photons by the conservative scheme, if it is chosen, and computes paths. Collective.
void vtkPhotonMarcher::MarchThrough(tyndall::PhotonMarcher& marcher, tyndall::Communicator& communicator,
  const std::vector<tyndall::Photon>& photons, Marched& marched)
{
  if (this->Scheme != PUBLISHED)
  {
    marched.light = marcher.March(photons, tyndall::MonitorOf(this));
  }
  if (this->PathCount > 0)
  {
    const std::size_t all = tyndall::PlaceAmong(communicator, photons.size()).all;
    marched.paths = marcher.Paths(photons, tyndall::ChooseEvenly(all, static_cast<std::size_t>(this->PathCount)));
  }
}

/// Marches photons with one piece of the medium per rank. Collective.
/// @return false, on all ranks, if each rank is to march through the whole medium
bool vtkPhotonMarcher::MarchPiece(vtkInformation* request, vtkMultiProcessController* ranks,
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkImageData* const image = vtkImageData::GetData(inputs[MediumPort]);
  const std::optional<tyndall::AgreedBlocks> agreed = tyndall::AgreeOnBlocks(
    ranks, this, this->WantsBlocks(request, inputs, outputs), tyndall::AskingPort(request, outputs), image);
  if (!agreed)
  {
    return false;
  }
  tyndall::Communicator* const communicator = agreed->communicator.get();
  const tyndall::PieceBlocks& pieces = *agreed->pieces;
  PieceOfMarch piece;
  const bool needsPieces = tyndall::NeedsPieces(request, inputs[MediumPort], outputs, BytesOfVoxel);
  if (!this->ReadPiece(*communicator, pieces, inputs, needsPieces, piece))
  {
    return false;
  }
  this->Kept->Forget();
  std::shared_ptr<tyndall::Device> device;
  communicator->Collective([&] { device = tyndall::FindWithin(this->Within, this->Device, this->MemoryBudget); });
  tyndall::RequireSame(
    *communicator, "Scheme or PathCount", true, { 1.0 * this->Scheme, static_cast<double>(this->PathCount) });
  const tyndall::Domain domain(*communicator, pieces.Partition());
  Marched marched;
  if (this->Scheme == PUBLISHED)
  {
    this->MarchAsPublished(*device, domain, piece.read, piece.photons, marched);
  }
  if (this->Scheme != PUBLISHED || this->PathCount > 0)
  {
    tyndall::PhotonMarcher marcher(
      *device, domain, piece.read.input.medium, piece.read.ior, piece.settings, piece.read.Levels());
    this->MarchThrough(marcher, *communicator, piece.photons, marched);
  }
  this->WarnOfBox(inputs, pieces.Partition().whole);
  this->Note(marched);
  this->Ignored = tyndall::IgnoredEmission(tyndall::OnAnyRank(*communicator, piece.emits));
  this->Warn(marched.light, tyndall::PlaceAmong(*communicator, piece.photons.size()).all);
  SpreadToHeld(*communicator, pieces, marched.light);
  vtkImageData* const output = vtkImageData::GetData(outputs, 0);
  tyndall::PassOn(image, output);
  pieces.KeepHeld(output);
  if (communicator->Rank() == 0)
  {
    tyndall::WritePaths(marched.paths, tyndall::OwnAxesOf(this), vtkPolyData::GetData(outputs, 1));
  }
  if (pieces.Held().VoxelCount() > 0)
  {
    this->Write(std::move(marched), image, output);
  }
  return true;
}

vtkPhotonMarcher::Marched vtkPhotonMarcher::March(
  vtkInformationVector** inputs, const std::vector<tyndall::Photon>& photons)
{
  this->Kept->ForgetIfRan(this, { MediumPort, OctreePort });
  const tyndall::MarchSettings settings = SettingsOf(
    this, vtkImageData::GetData(inputs[MediumPort]), std::any_of(photons.begin(), photons.end(), IsOfLaterBatch));
  Marched marched;
  if (this->Scheme == PUBLISHED)
  {
    const tyndall::RefractiveInput read = tyndall::ReadRefractiveMedium(
      this, vtkImageData::GetData(inputs[MediumPort]), vtkImageData::GetData(inputs[OctreePort]));
    this->MarchAsPublished(*tyndall::FindWithin(this->Within, this->Device, this->MemoryBudget),
      tyndall::Domain(read.input.medium.grid), read, photons, marched);
    if (this->PathCount == 0)
    {
      this->Kept->Forget();
      return marched;
    }
  }
  tyndall::KeptMarcher::Found found =
    this->Kept->Find(this, tyndall::FindWithin(this->Within, this->Device, this->MemoryBudget),
      vtkImageData::GetData(inputs[MediumPort]), vtkImageData::GetData(inputs[OctreePort]), settings);
  tyndall::SingleRank single;
  this->MarchThrough(*found.marcher, single, photons, marched);
  this->MediumKept = found.kept;
  this->Kept->Keep(std::move(found));
  return marched;
}

int vtkPhotonMarcher::RequestData(vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->Note({});
  this->MediumKept = false;
  const tyndall::WorkOnPieces onPieces = { MediumPort,
    [&](vtkMultiProcessController* ranks, vtkInformationVector** inputs) {
      this->IsFirstRank = !ranks || ranks->GetLocalProcessId() == 0;
      return this->MarchPiece(request, ranks, inputs, outputs);
    },
    PhotonsPort, { OctreePort } };
  return tyndall::Guarded(this, request, given, outputs, onPieces, [&](vtkInformationVector** inputs) {
    const std::vector<tyndall::Photon> photons =
      tyndall::ReadPhotons(vtkPolyData::GetData(inputs[PhotonsPort]), tyndall::OwnAxesOf(this));
    this->WarnOfBox(inputs, tyndall::GridOf(vtkImageData::GetData(inputs[MediumPort])));
    Marched marched = this->March(inputs, photons);

    this->Note(marched);
    vtkImageData* const medium = vtkImageData::GetData(inputs[MediumPort]);
    this->Ignored = tyndall::IgnoredEmission(tyndall::IsUnusual(this, tyndall::Emission, medium, "emission", 0.0f));
    this->Warn(marched.light, photons.size());
    vtkImageData* output = vtkImageData::GetData(outputs, 0);
    tyndall::PassOn(medium, output);
    if (tyndall::IsFirstPiece(request, outputs))
    {
      tyndall::WritePaths(marched.paths, tyndall::OwnAxesOf(this), vtkPolyData::GetData(outputs, 1));
    }
    this->Write(std::move(marched), medium, output);
    tyndall::KeepWhatIsAskedFor(outputs->GetInformationObject(0), output);
  });
}

void vtkPhotonMarcher::WarnOfBox(vtkInformationVector** inputs, const tyndall::Grid& medium)
{
  const std::string doubt = tyndall::DoubtOfBox(vtkPolyData::GetData(inputs[PhotonsPort]), medium);
  if (!doubt.empty())
  {
    vtkWarningMacro(<< doubt);
  }
}

void vtkPhotonMarcher::Write(Marched&& marched, vtkImageData* medium, vtkImageData* output)
{
  WriteLightOf(std::move(marched.light), output);
  tyndall::NoteChoices(this, tyndall::QuantitiesOfMedium(), medium, output);
  if (!this->Ignored.empty())
  {
    tyndall::AddFact(output, tyndall::IgnoredFact, this->Ignored);
  }
  if (this->Scheme == PUBLISHED)
  {
    tyndall::AddFact(output, "packing_loss", std::vector<double>{ marched.packingLoss });
  }
}

void vtkPhotonMarcher::Note(const Marched& marched)
{
  const tyndall::PhotonLight& light = marched.light;
  this->PackingLoss = marched.packingLoss;
  this->Deposits = static_cast<vtkIdType>(light.deposits);
  this->Steps = static_cast<vtkIdType>(light.steps);
  this->Missed = static_cast<vtkIdType>(light.missed);
  this->Scatterings = static_cast<vtkIdType>(light.scatterings);
  this->BalanceError = light.light.balance.RelativeError(light.light.channels);
  this->Seconds = light.seconds;
  this->DeviceName = light.light.device;
  this->LeftOut = tyndall::Lines(light.light.leftOut);
}

/// Issues warnings, on the first rank only, because all ranks share the result.
void vtkPhotonMarcher::Warn(const tyndall::PhotonLight& light, std::size_t photons)
{
  if (!this->IsFirstRank)
  {
    return;
  }
  if (!this->Ignored.empty())
  {
    vtkWarningMacro(<< tyndall::WarningOf(this->Ignored));
  }
  if (this->Missed > 0)
  {
    vtkWarningMacro(
      << this->Missed << " of " << photons
      << " photons do not meet the medium, so their power is not in it. Give PhotonEmitter the same medium.");
  }
  for (const std::string& doubt : light.light.doubts)
  {
    vtkWarningMacro(<< doubt);
  }
  const tyndall::EnergyBalance& balance = light.light.balance;
  const double trapped =
    tyndall::Sum(balance.entered) > 0.0 ? tyndall::Sum(balance.leftOver) / tyndall::Sum(balance.entered) : 0.0;
  if (trapped > 0.01 && this->MaximumOrders < 2) // else left over is the power of omitted scattering orders
  {
    vtkWarningMacro(
      << std::lround(100.0 * trapped)
      << "% of the power that entered still went round when its photons were given up, and is missing from "
         "fluence: total reflection traps it, as that of a lamp in a ball of a high index. Absorption would "
         "end it.");
  }
}

void vtkPhotonMarcher::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(PointData, Scheme, IntegratorOrder, StepSize, LeaveOut, EmptySpace, Decomposition, PhotonCounts,
    MaximumOrders, Seed, ErrorBatches, PathCount, Smoothing, MemoryBudget, Device, Deposits, Steps, Scatterings, Missed,
    BalanceError, PackingLoss, MediumKept, Seconds, DeviceName, LeftOut);
}
