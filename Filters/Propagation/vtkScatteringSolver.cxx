#include "vtkScatteringSolver.h"

#include "Common/Failure.h"
#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Device/Errors.h"
#include "Distribution/SharedMedium.h"
#include "Lights/Lights.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/PieceBlocks.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"
#include "Propagation/LastOutputs.h"
#include "Propagation/SolverScene.h"
#include "Viewing/LitColor.h"

#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>
#include <utility>

namespace tyndall
{
SolverScene::SolverScene(const PieceBlocks& ofRanks, vtkAlgorithm* filter, vtkImageData* given)
  : pieces(ofRanks)
  , domain(ofRanks.GetDomain())
{
  this->domain.Collective([&] { this->image = this->pieces.OwnImage(given); });
  this->input = ReadMedium(filter, this->domain, this->image);
  this->medium = this->input.medium;
  this->emits = this->domain.Any(this->input.Emits());
}
}

namespace
{
/// Extends the arrays of a subdomain's solution to all voxels of the output, ghost cells included. Collective.
void SpreadToHeld(const tyndall::PieceBlocks& pieces, tyndall::LightField& light)
{
  const auto spread = [&](std::vector<float>& values, int components) { pieces.SpreadToHeld(values, components); };
  const std::size_t voxels = std::max<std::size_t>(pieces.Own().VoxelCount(), 1);
  const int stored = std::max(static_cast<int>(light.storedDirections.size()), 1);
  spread(light.fluence, light.channels);
  spread(light.fluenceDirect, light.channels);
  spread(light.fluenceError, light.channels);
  spread(light.netFlux, 3 * light.channels);
  spread(light.scatteredRadiance, light.channels * stored);
  // Numbers of components of scatteredMoments and straightOn, unknown on ranks without voxels.
  const std::vector<double> ofMoments =
    pieces.GetDomain().Max({ static_cast<double>(light.scatteredMoments.size() / voxels),
      static_cast<double>(light.straightOn.size() / voxels) });
  spread(light.scatteredMoments, static_cast<int>(ofMoments[0]));
  spread(light.straightOn, static_cast<int>(ofMoments[1]));
}
}

vtkScatteringSolver::vtkScatteringSolver()
  : Solved(std::make_unique<tyndall::LastOutputs>())
{
  this->SetNumberOfInputPorts(UNCOLLIDED + 1);
  this->SetNumberOfOutputPorts(2);
}

vtkScatteringSolver::~vtkScatteringSolver() = default;

int vtkScatteringSolver::FillOutputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

tyndall::IlluminationInput vtkScatteringSolver::ReadShining(tyndall::SolverScene& scene, vtkInformationVector** inputs)
{
  tyndall::IlluminationInput input;
  if (inputs[UNCOLLIDED]->GetNumberOfInformationObjects() == 0)
  {
    input = this->ReadAllIllumination(inputs, scene.emits);
    if (this->ReadsQuality())
    {
      tyndall::SetFineness(input.illumination.lights, static_cast<tyndall::Quality>(this->Quality));
    }
    return input;
  }
  if (scene.image)
  {
    scene.uncollided = scene.pieces.OwnImage(vtkImageData::GetData(inputs[UNCOLLIDED]));
    input.uncollided = tyndall::ReadUncollided(scene.uncollided, tyndall::GridOf(scene.image));
    input.illumination.uncollided = input.uncollided.image;
  }
  tyndall::AddFaceAlbedo(input.illumination, this->FaceAlbedo, this->FaceAlbedoColor);
  return input;
}

void vtkScatteringSolver::ColorsModified()
{
  this->ColorsTime.Modified();
  this->InvokeEvent(vtkCommand::ModifiedEvent);
}

void vtkScatteringSolver::SetLitColor(bool make)
{
  if (this->LitColor != make)
  {
    this->LitColor = make;
    this->ColorsModified();
  }
}

void vtkScatteringSolver::SetExposure(double exposure)
{
  if (tyndall::SetInRange<double>(this, "Exposure", &this->Exposure, { exposure }, 0.0, 1e30))
  {
    this->ColorsModified();
  }
}

void vtkScatteringSolver::SetToneCurve(int curve)
{
  if (tyndall::SetInRange<int>(this, "ToneCurve", &this->ToneCurve, { curve }, 0.0, 1.0))
  {
    this->ColorsModified();
  }
}

vtkMTimeType vtkScatteringSolver::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->ColorsTime.GetMTime());
}

int vtkScatteringSolver::RequestData(
  vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  vtkMultiProcessController* const ranks = tyndall::RanksTogether(request, outputs);
  this->OverRanks = ranks != nullptr;
  this->IsFirstRank = !ranks || ranks->GetLocalProcessId() == 0;
  this->WholeFor.clear();
  this->HasSolved = false;
  const bool chooses = this->Decomposition == AUTOMATIC_DECOMPOSITION && tyndall::EachAsksForItsPiece(request, outputs);
  tyndall::WorkOnSubdomains work;
  work.port = MEDIUM;
  work.shares = this->PortOfShares();
  work.others = { UNCOLLIDED };
  work.wantsPieces = [&](vtkInformationVector** inputs) { return this->WantsPieces(request, inputs, outputs); };
  work.work = [&](const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs) {
    if (!pieces.IsDecomposed() && chooses && this->WholeFor.empty())
    {
      this->WholeFor = this->ReasonNotToAgree(inputs);
    }
    return this->UpdateCachedOrSolve(pieces, inputs, outputs);
  };
  work.shareResults = [this](tyndall::Communicator& all) { this->ShareResults(all); };
  const int done = tyndall::Guarded(this, request, given, outputs, work);
  if (tyndall::AreEmptied(outputs))
  {
    this->RestoreLightBefore(outputs);
  }
  else if (!this->HasSolved && vtkImageData::GetData(outputs, 0)->GetNumberOfCells() > 0)
  {
    // Caches this rank's piece of the solution of the first rank, to be shown if a later solve is aborted
    // (RestoreLightBefore).
    this->Solved->Keep({}, {}, outputs);
    this->SolvedInPieces = true;
  }
  return done;
}

/// Sets the outputs of an aborted solve to those of the last complete solve, if there are any, so that views keep
/// showing them, and resets the read-only properties. Outputs of a failed solve stay empty.
void vtkScatteringSolver::RestoreLightBefore(vtkInformationVector* outputs)
{
  tyndall::LightField nothing;
  vtkImageData* const output = vtkImageData::GetData(outputs, 0);
  tyndall::OwnAxes axes;
  if (output->GetFieldData()->HasArray(tyndall::AbortedFact) && this->Solved->GiveBefore(outputs, axes))
  {
    nothing.leftOut = { tyndall::LightOfBefore };
    if (!this->SolvedInPieces)
    {
      tyndall::KeepWhatIsAskedFor(outputs->GetInformationObject(0), output);
    }
    tyndall::PutIntoScene(output, axes, nullptr);
  }
  this->Note(nothing);
}

/// Whether this rank prefers, or with BLOCKS requires, a solve on its piece of the medium; the result may differ
/// between ranks.
bool vtkScatteringSolver::WantsPieces(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) const
{
  return this->Decomposition == AUTOMATIC_DECOMPOSITION ? tyndall::EachAsksForItsPiece(request, outputs) &&
      tyndall::IsWorthPieces(inputs[MEDIUM]) && this->NotByBlocks(inputs).empty()
                                                        : this->Decomposition == BLOCKS;
}

/// Text for field data `left_out`: why the first rank solves the whole domain, although Decomposition is automatic and
/// each rank requests its own piece.
std::string vtkScatteringSolver::ReasonNotToAgree(vtkInformationVector** inputs) const
{
  const std::string refused = this->NotByBlocks(inputs);
  return !refused.empty()                    ? refused
    : tyndall::IsWorthPieces(inputs[MEDIUM]) ? "pieces that are not parts of one grid"
                                             : "a medium of few voxels";
}

int vtkScatteringSolver::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bool asPiece = tyndall::EachAsksForItsPiece(request, outputs) && this->WantsPieces(request, inputs, outputs);
  const std::vector<int> besides = asPiece ? std::vector<int>{ UNCOLLIDED, this->PortOfShares() } : std::vector<int>();
  tyndall::AskForAllBut(asPiece ? MEDIUM : -1, request, inputs, this->GetNumberOfInputPorts(), outputs, besides);
  return 1;
}

std::string vtkScatteringSolver::NotByBlocks(vtkInformationVector**) const
{
  return {};
}

std::string vtkScatteringSolver::ReasonNotToDecompose(const tyndall::SolverScene&)
{
  return {};
}

/// Whether the medium's refractive index is not 1 everywhere and the solver ignores it.
/// @param medium  may be null or without voxels
bool vtkScatteringSolver::IgnoresIndexOf(vtkImageData* medium)
{
  return !this->KnowsIndex() && medium && medium->GetNumberOfCells() > 0 &&
    tyndall::IsUnusual(this, tyndall::RefractiveIndex, medium, "ior", 1.0f);
}

/// Reads the light sources of the subdomain into `scene`, unless a property or an input rules out the decomposition.
/// @return the property or input that rules it out, as text; empty if none does
/// @throws InvalidInput if Decomposition is BLOCKS and a property or an input rules it out
std::string vtkScatteringSolver::ReadShiningOrRefuse(tyndall::SolverScene& scene, vtkInformationVector** inputs)
{
  const bool split = scene.pieces.IsDecomposed(), mustSplit = this->Decomposition == BLOCKS;
  std::string refused = split || mustSplit ? this->NotByBlocks(inputs) : "";
  vtkImageData* const uncollided = vtkImageData::GetData(inputs[UNCOLLIDED]);
  if (split && refused.empty() && uncollided && !scene.pieces.HasOwnOf(uncollided))
  {
    refused = "UncollidedLight in other pieces than the medium";
  }
  tyndall::Require(refused.empty() || !mustSplit,
    "Ranks cannot solve their pieces (Decomposition: blocks) with " + refused +
      ". Leave it out, or let the first rank solve the whole.");
  if (refused.empty())
  {
    scene.shining = this->ReadShining(scene, inputs);
  }
  return refused;
}

/// Reads the light sources of the subdomain into `scene`. If the first rank is to solve the whole domain, sets WholeFor
/// to the reason. Collective.
/// @return false, on all ranks, if the first rank is to solve the whole domain
bool vtkScatteringSolver::ReadOrRefuse(tyndall::SolverScene& scene, vtkInformationVector** inputs)
{
  scene.share = this->PortOfShares() < 0 ? nullptr : vtkPolyData::GetData(inputs[this->PortOfShares()]);
  std::string refused;
  bool ignoresIndex = false;
  scene.domain.Collective([&] {
    ignoresIndex = this->IgnoresIndexOf(scene.image);
    refused = this->ReadShiningOrRefuse(scene, inputs);
  });
  this->Ignored = tyndall::IgnoredIndex(scene.domain.Any(ignoresIndex));
  if (scene.domain.IsSerial())
  {
    return true;
  }
  this->WholeFor = tyndall::WordsOfAny(scene.domain.Comm(), refused);
  tyndall::RequireSame(scene.domain.Comm(), "Preview", true, { this->Preview ? 1.0 : 0.0 });
  tyndall::RequireSame(
    scene.domain.Comm(), "TargetError or EstimateError", true, { this->TargetError, this->EstimateError ? 1.0 : 0.0 });
  const bool chooses = !this->Preview && !scene.domain.Any(this->Decomposition == BLOCKS);
  if (this->WholeFor.empty() && chooses)
  {
    this->WholeFor = this->ReasonNotToDecompose(scene);
  }
  return this->WholeFor.empty();
}

/// Writes this subdomain's cached solution to the outputs if it is valid on all ranks, else solves. Collective.
/// @return false, on all ranks, if the first rank is to solve the whole domain
bool vtkScatteringSolver::UpdateCachedOrSolve(
  const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const tyndall::OwnAxes axes = tyndall::OwnAxesOf(this);
  tyndall::LastOutputs::Key key =
    tyndall::LastOutputs::KeyOf(this->Superclass::GetMTime(), axes, inputs, this->GetNumberOfInputPorts());
  if (!pieces.IsDecomposed() && std::exchange(this->SolvedInPieces, false))
  {
    this->Solved->Forget();
  }
  const bool kept = this->SolvedInPieces == pieces.IsDecomposed() && this->Solved->GiveBack(key, outputs);
  const vtkIdType cells = vtkImageData::GetData(outputs, 0)->GetNumberOfCells();
  const bool same = kept && (!pieces.IsDecomposed() || cells == static_cast<vtkIdType>(pieces.Held().VoxelCount()));
  if (pieces.GetDomain().Any(!same))
  {
    if (kept)
    {
      this->Solved->LetGo();
    }
    this->Note({});
    tyndall::SolverScene scene(pieces, this, vtkImageData::GetData(inputs[MEDIUM]));
    if (!this->ReadOrRefuse(scene, inputs))
    {
      return false;
    }
    if (!scene.share)
    {
      this->WarnWhereDark(scene.shining.illumination, scene.emits);
    }
    tyndall::LightField light = this->Solve(scene);
    TellOfDefaultSky(scene.shining, light.leftOut);
    this->Write(pieces, std::move(light), inputs, outputs);
    this->Solved->Keep(std::move(key), axes, outputs);
    this->SolvedInPieces = pieces.IsDecomposed();
  }
  else
  {
    tyndall::NoteGivenBack(this);
  }
  this->Color(pieces, inputs, outputs);
  this->HasSolved = true;
  return true;
}

/// Writes the solution and the medium's arrays to output 0 and the convergence history to output 1, sets the read-only
/// properties, and issues the solve's warnings on the first rank. Collective.
void vtkScatteringSolver::Write(const tyndall::PieceBlocks& pieces, tyndall::LightField&& light,
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bool blocks = pieces.IsDecomposed() || (!this->OverRanks && this->Decomposition == BLOCKS);
  if (this->OverRanks || blocks)
  {
    light.settingsUsed.push_back("Decomposition = " + std::to_string(blocks ? BLOCKS : WHOLE));
  }
  tyndall::AddAveraged(this, light.settingsUsed);
  if (this->OverRanks && !this->WholeFor.empty())
  {
    light.leftOut.push_back("pieces: the first rank solved the whole, for " + this->WholeFor);
  }
  this->Note(light);
  SpreadToHeld(pieces, light);
  std::vector<std::string> doubts = light.doubts;
  if (!this->Ignored.empty())
  {
    doubts.push_back(tyndall::WarningOf(this->Ignored));
  }
  pieces.GetDomain().Collective([&] {
    tyndall::WriteConvergence(light.convergence, light.sweepsSaved, vtkTable::GetData(outputs, 1));
    vtkImageData* const medium = vtkImageData::GetData(inputs[MEDIUM]);
    vtkImageData* const output = vtkImageData::GetData(outputs, 0);
    tyndall::PassOn(medium, output);
    pieces.KeepHeld(output);
    if (pieces.Held().VoxelCount() > 0)
    {
      tyndall::WriteLight(std::move(light), output); // before any warning, because it throws if a value is not finite
      tyndall::NoteChoices(this, tyndall::QuantitiesOfMedium(), medium, output);
      const double* const entering = this->FaceRadiance;
      if (output->GetCellData()->HasArray(tyndall::MomentsArray) &&
        std::any_of(entering, entering + 6, [](double radiance) { return radiance > 0.0; }))
      {
        tyndall::AddFact(output, tyndall::FaceRadianceFact, std::vector<double>(entering, entering + 6), 1);
      }
      if (!this->Ignored.empty())
      {
        tyndall::AddFact(output, tyndall::IgnoredFact, this->Ignored);
      }
    }
  });
  for (const std::string& doubt : this->IsFirstRank ? doubts : std::vector<std::string>())
  {
    vtkWarningMacro(<< doubt);
  }
}

/// Adds the cell array `lit_color` to output 0 of this rank if LitColor is on. Collective.
void vtkScatteringSolver::Color(
  const tyndall::PieceBlocks& pieces, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const tyndall::Domain& domain = pieces.GetDomain();
  tyndall::RequireSame(domain.Comm(), "LitColor, Exposure or ToneCurve", true,
    { this->LitColor ? 1.0 : 0.0, this->Exposure, 1.0 * this->ToneCurve });
  if (!this->LitColor)
  {
    return;
  }
  vtkImageData* const output = vtkImageData::GetData(outputs, 0);
  const tyndall::SolverScene scene(pieces, this, vtkImageData::GetData(inputs[MEDIUM]));
  vtkSmartPointer<vtkImageData> own; // owns the array of `fluence`; null if the subdomain has no voxels
  tyndall::FloatField fluence;
  domain.Collective([&] {
    own = pieces.OwnImage(output);
    fluence = own ? tyndall::ReadCells(own, "fluence", tyndall::Need::Required) : fluence;
  });
  tyndall::ToneMapping tones;
  tones.exposure = this->Exposure;
  tones.curve = static_cast<tyndall::ToneCurve>(this->ToneCurve);
  tyndall::LitColor lit = tyndall::ColorLitMedium(scene.domain, scene.medium, fluence, tones);
  if (pieces.IsDecomposed())
  {
    std::vector<float> rgba(lit.rgba.begin(), lit.rgba.end());
    pieces.SpreadToHeld(rgba, 4);
    lit.rgba.assign(rgba.begin(), rgba.end());
  }
  if (pieces.Held().VoxelCount() > 0)
  {
    tyndall::WriteLitColor(std::move(lit), output);
  }
}

void vtkScatteringSolver::Note(const tyndall::LightField& light)
{
  const bool any = !light.convergence.empty();
  this->Residual = any ? light.convergence.back().residual : 0.0;
  this->EstimatedError = light.relativeError;
  this->Solves = any ? light.solves : 0;
  this->BalanceError = light.balance.RelativeError(light.channels);
  this->DeviceName = light.device;
  tyndall::NoteLeftOut(this, tyndall::Lines(light.leftOut));
  this->SettingsUsed = tyndall::Lines(light.settingsUsed);
}

void vtkScatteringSolver::ShareResults(tyndall::Communicator& ranks)
{
  tyndall::TakeFromFirstRank(ranks, this->Residual, this->EstimatedError, this->Solves, this->BalanceError,
    this->DeviceName, this->SettingsUsed);
}

void vtkScatteringSolver::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(Decomposition, Quality, TargetError, Preview, MemoryBudget, LeaveOut, LitColor, Exposure, ToneCurve,
    Residual, EstimatedError, Solves, BalanceError, DeviceName, SettingsUsed);
  tyndall::PrintRun(os, indent, this);
}
