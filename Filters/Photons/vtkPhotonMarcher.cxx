#include "vtkPhotonMarcher.h"

#include "Common/AvailableMemory.h"
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
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace
{
enum InputPort
{
  MediumPort,
  PhotonsPort,
  OctreePort,
  InputPortCount
};

/// Whether EmptySpace selects storage of light by bricks of 8^3 voxels. The medium's field data `active_part` may be
/// out of date, but affects only how light is stored, not its values.
bool ByBricks(vtkPhotonMarcher* filter, vtkImageData* medium)
{
  constexpr double mostActive = 0.25;
  const bool sparse = medium && tyndall::ReadFact(medium, tyndall::ActivePartFact, 1.0) <= mostActive;
  return filter->GetEmptySpace() == vtkPhotonMarcher::BY_BRICK ||
    (filter->GetEmptySpace() == vtkPhotonMarcher::AS_READ && sparse);
}

/// Memory, bytes per voxel, of a rank that marches photons through the whole medium: the medium's arrays, the spline of
/// the refractive index, the fixed-point sums of fluence, and the arrays of fluence.
constexpr double BytesOfVoxel = 96.0;

bool IsOfLaterBatch(const tyndall::Photon& photon)
{
  return photon.batch > 0;
}

/// Settings of the march from the filter's properties.
/// @param medium  image of this rank's block; null if it has no voxels
/// @param batches  whether any rank has photons of several batches
/// @throws InvalidInput if the published scheme is chosen with properties that it does not support
tyndall::MarchSettings SettingsOf(vtkPhotonMarcher* filter, vtkImageData* medium, bool batches)
{
  const bool published = filter->GetScheme() == vtkPhotonMarcher::PUBLISHED;
  tyndall::Require(!published || filter->GetMaximumOrders() == 1,
    "The published scheme follows photons to where they are first scattered. Choose the "
    "conservative scheme (Scheme 1), or MaximumOrders 1.");
  tyndall::Require(!published || !filter->GetPhotonCounts(),
    "The published scheme packs all that it keeps of a voxel into 64 bits, and does not count "
    "photons. Choose the conservative scheme (Scheme 1), or switch PhotonCounts off.");
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

/// Extends the arrays of fluence of this rank's block to all voxels of the output, ghost cells included. Collective.
void SpreadToHeld(const tyndall::PieceBlocks& pieces, tyndall::PhotonLight& photons)
{
  pieces.SpreadToHeld(photons.light.fluence, photons.light.channels);
  pieces.SpreadToHeld(photons.light.fluenceDirect, photons.light.channels);
  pieces.SpreadToHeld(photons.light.fluenceError, photons.light.channels);
  pieces.SpreadToHeld(photons.batchFluence, photons.light.channels * photons.batches);
  pieces.SpreadToHeld(photons.meanDirection, 3);
  pieces.SpreadToHeld(photons.photonCount, 1);
  pieces.SpreadToHeld(photons.photonWeight, 1);
}

void WriteLightOf(tyndall::PhotonLight&& photons, vtkImageData* output)
{
  const int channels = photons.light.channels;
  const bool scattered = photons.scatterings > 0;
  const bool direct = photons.light.fluenceDirect.empty(); // without scattered photons, fluence is the uncollided flux
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

/// Input of a march on this rank: the rank's block of the medium and its share of the photons.
struct vtkPhotonMarcher::MarchInput
{
  vtkSmartPointer<vtkImageData> image,
    octree; ///< image of the octree of this rank's block; null without octree or without voxels
  tyndall::MarchSettings settings;
  std::vector<tyndall::Photon> photons; ///< this rank's share of the photons
};

/// Result of a march: fluence and related arrays, packing loss (fraction of the deposited power that the published
/// scheme's 64 bits per voxel did not keep; 0 for the other scheme), and the photons' paths, which are computed by the
/// conservative scheme's integrator.
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

/// Whether this rank prefers to march photons through its piece of the medium (BLOCKS): decided by Decomposition, the
/// pipeline's request and the medium's size.
bool vtkPhotonMarcher::WantsBlocks(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) const
{
  return this->Decomposition == AUTOMATIC_DECOMPOSITION
    ? tyndall::EachAsksForItsPiece(request, outputs) && tyndall::IsWorthPieces(inputs[MediumPort])
    : this->Decomposition == BLOCKS;
}

/// Frees the device memory of a cached medium that is out of date before upstream filters run. Requests this rank's
/// piece of each input if photons are marched through the pieces (BLOCKS), else the complete inputs.
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
/// Image of the octree, cropped to this rank's block.
/// @param medium  image of this rank's block of the medium
/// @return null if the cropped image has other voxels than `medium`, or `octree` has no cells
vtkSmartPointer<vtkImageData> OctreeOf(const tyndall::PieceBlocks& pieces, vtkImageData* octree, vtkImageData* medium)
{
  if (octree->GetNumberOfCells() == 0)
  {
    return nullptr;
  }
  const vtkSmartPointer<vtkImageData> own = pieces.OwnImage(octree);
  return tyndall::AreSameVoxels(tyndall::GridOf(own), tyndall::GridOf(medium)) ? own : nullptr;
}
}

/// Finds this rank's block of the medium and share of the photons. Collective.
/// @return false, on all ranks, if the first rank is to march through the whole medium: pieces of the octree differ
///   from those of the medium, or light is stored by bricks of 8^3 voxels
bool vtkPhotonMarcher::FindInput(const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs, MarchInput& input)
{
  const tyndall::Domain& domain = pieces.GetDomain();
  vtkImageData* const medium = vtkImageData::GetData(inputs[MediumPort]);
  vtkImageData* const octree = vtkImageData::GetData(inputs[OctreePort]);
  input.photons =
    tyndall::ShareOfPhotons(domain.Comm(), vtkPolyData::GetData(inputs[PhotonsPort]), tyndall::OwnAxesOf(this));
  const bool batches = domain.Any(std::any_of(input.photons.begin(), input.photons.end(), IsOfLaterBatch));
  bool whole = false; // whether a march through the whole medium is preferred or necessary
  domain.Collective([&] {
    input.image = pieces.OwnImage(medium);
    input.settings = SettingsOf(this, input.image, batches);
    input.octree = octree;
    if (octree && pieces.IsDecomposed())
    {
      input.octree = input.image ? OctreeOf(pieces, octree, input.image) : nullptr;
    }
    const bool octreeElsewhere = octree && input.image && !input.octree;
    tyndall::Require(!octreeElsewhere || this->Decomposition != BLOCKS,
      "Ranks cannot march photons through their pieces (Decomposition: blocks) with an octree that lies in other "
      "pieces on ranks than the medium. Leave it out, or let the first rank have the whole.");
    const bool prefersWhole = this->Decomposition == AUTOMATIC_DECOMPOSITION && input.settings.byBricks &&
      !tyndall::NeedsPieces(inputs[MediumPort], BytesOfVoxel);
    whole = pieces.IsDecomposed() && (octreeElsewhere || prefersWhole);
  });
  return !domain.Any(whole);
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

/// Marches photons if Scheme is CONSERVATIVE, and computes the paths of PathCount photons with either scheme.
/// Collective.
void vtkPhotonMarcher::MarchThrough(tyndall::PhotonMarcher& marcher, tyndall::Communicator& communicator,
  const std::vector<tyndall::Photon>& photons, Marched& marched)
{
  if (this->Scheme != PUBLISHED)
  {
    const std::string warning = marcher.Warning(photons);
    if (!warning.empty() && communicator.Rank() == 0)
    {
      vtkWarningMacro(<< warning);
    }
    marched.light = marcher.March(photons, tyndall::MonitorOf(this));
  }
  if (this->PathCount > 0)
  {
    const std::size_t all = tyndall::PlaceAmong(communicator, photons.size()).all;
    marched.paths = marcher.Paths(photons, tyndall::ChooseEvenly(all, static_cast<std::size_t>(this->PathCount)));
  }
}

/// Marches this rank's photons and writes the fluence of its block. Collective.
/// @return false, on all ranks, if the first rank is to march through the whole medium
bool vtkPhotonMarcher::March(
  const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const tyndall::Domain& domain = pieces.GetDomain();
  MarchInput input;
  if (!this->FindInput(pieces, inputs, input))
  {
    return false;
  }
  this->Kept->ForgetIfRan(this, { MediumPort, OctreePort });
  std::shared_ptr<tyndall::Device> device;
  domain.Collective([&] { device = tyndall::FindWithin(this->Within, this->Device, this->MemoryBudget); });
  tyndall::RequireSame(
    domain.Comm(), "Scheme or PathCount", true, { 1.0 * this->Scheme, static_cast<double>(this->PathCount) });
  Marched marched;
  if (this->Scheme == PUBLISHED)
  {
    const tyndall::RefractiveInput read = tyndall::ReadRefractiveMedium(this, domain, input.image, input.octree);
    this->MarchAsPublished(*device, domain, read, input.photons, marched);
  }
  if (this->Scheme != PUBLISHED || this->PathCount > 0)
  {
    tyndall::KeptMarcher::Found found =
      this->Kept->Find(this, device, domain, input.image, input.octree, input.settings);
    this->MarchThrough(*found.marcher, domain.Comm(), input.photons, marched);
    this->MediumKept = found.kept;
    if (domain.IsSerial())
    {
      this->Kept->Keep(std::move(found));
    }
  }
  else
  {
    this->Kept->Forget();
  }
  this->Write(pieces, input, std::move(marched), inputs, outputs);
  return true;
}

int vtkPhotonMarcher::RequestData(vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->Note({});
  this->MediumKept = false;
  tyndall::WorkOnSubdomains work;
  work.port = MediumPort;
  work.shares = PhotonsPort;
  work.others = { OctreePort };
  work.wantsPieces = [&](vtkInformationVector** inputs) { return this->WantsBlocks(request, inputs, outputs); };
  work.work = [&](const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs) {
    return this->March(pieces, inputs, outputs);
  };
  work.shareResults = [this](tyndall::Communicator& ranks) {
    tyndall::TakeFromFirstRank(ranks, this->PackingLoss, this->Deposits, this->Steps, this->Missed, this->Scatterings,
      this->BalanceError, this->MediumKept, this->DeviceName);
  };
  const int done = tyndall::Guarded(this, request, given, outputs, work);
  if (!tyndall::IsFirstPiece(request, outputs) && !tyndall::AreEmptied(outputs))
  {
    vtkPolyData::GetData(outputs, 1)->Initialize(); // paths are returned with the first piece only
  }
  return done;
}

void vtkPhotonMarcher::WarnOfBox(vtkInformationVector** inputs, const tyndall::Grid& medium)
{
  const std::string doubt = tyndall::DoubtOfBox(vtkPolyData::GetData(inputs[PhotonsPort]), medium);
  if (!doubt.empty())
  {
    vtkWarningMacro(<< doubt);
  }
}

/// Sets the read-only properties, warns, and writes the fluence of this rank's block and, on the first rank, the paths.
/// Collective.
void vtkPhotonMarcher::Write(const tyndall::PieceBlocks& pieces, const MarchInput& input, Marched&& marched,
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const tyndall::Domain& domain = pieces.GetDomain();
  this->Note(marched);
  this->WarnOfBox(inputs, domain.Whole());
  this->Ignored = tyndall::IgnoredEmission(
    domain.Any(input.image && tyndall::IsUnusual(this, tyndall::Emission, input.image, "emission", 0.0f)));
  const std::size_t photons = tyndall::PlaceAmong(domain.Comm(), input.photons.size()).all;
  if (domain.Rank() == 0)
  {
    this->Warn(marched.light, photons);
    tyndall::WritePaths(marched.paths, tyndall::OwnAxesOf(this), vtkPolyData::GetData(outputs, 1));
  }
  SpreadToHeld(pieces, marched.light);
  vtkImageData* const medium = vtkImageData::GetData(inputs[MediumPort]);
  vtkImageData* const output = vtkImageData::GetData(outputs, 0);
  tyndall::PassOn(medium, output);
  pieces.KeepHeld(output);
  if (pieces.Held().VoxelCount() == 0)
  {
    return;
  }
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
  this->DeviceName = light.light.device;
  tyndall::NoteLeftOut(this, tyndall::Lines(light.light.leftOut));
}

/// Issues the warnings of a march. To be called on the first rank only, because the results of all ranks are equal.
/// @param photons  number of photons of all ranks
void vtkPhotonMarcher::Warn(const tyndall::PhotonLight& light, std::size_t photons)
{
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
  // If MaximumOrders is above 1, the left-over power is due to the scattering orders above MaximumOrders, and needs no
  // warning.
  if (trapped > 0.01 && this->MaximumOrders < 2)
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
    BalanceError, PackingLoss, MediumKept, DeviceName);
  tyndall::PrintRun(os, indent, this);
}
