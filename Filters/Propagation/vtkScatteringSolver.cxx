#include "vtkScatteringSolver.h"

#include "Common/LightTransportData.h"
#include "Device/Errors.h"
#include "Lights/Lights.h"
#include "Propagation/LastOutputs.h"
#include "Propagation/PieceOfMedium.h"
#include "Ranks/PieceBlocks.h"
#include "Ranks/RankMemory.h"
#include "Ranks/Ranks.h"
#include "Ranks/WholeImage.h"
#include "Viewing/LitColor.h"
#include "Work/GuardedWork.h"

#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkTable.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>
#include <vector>

namespace
{
/// Light beside the arrays of the medium, and its convergence.
/// @param pieces  of which the light is this rank's; null: it is the whole
/// @return its doubts
std::vector<std::string> Write(
  tyndall::LightField&& light, vtkImageData* medium, vtkInformationVector* outputs, const tyndall::PieceBlocks* pieces)
{
  std::vector<std::string> doubts = light.doubts;
  tyndall::WriteConvergence(light.convergence, light.sweepsSaved, vtkTable::GetData(outputs, 1));
  vtkImageData* const output = vtkImageData::GetData(outputs, 0);
  tyndall::PassOn(medium, output);
  if (pieces)
  {
    pieces->KeepHeld(output);
  }
  if (!pieces || pieces->Held().VoxelCount() > 0)
  {
    tyndall::WriteLight(std::move(light), output); // light that is not finite is an error, with no warnings before
  }
  return doubts;
}
}

vtkScatteringSolver::vtkScatteringSolver()
  : Solved(std::make_unique<tyndall::LastOutputs>())
{
  this->SetNumberOfInputPorts(UNCOLLIDED + 1);
  this->SetNumberOfOutputPorts(2);
}

vtkScatteringSolver::~vtkScatteringSolver() = default;

void vtkScatteringSolver::SetUncollidedLightConnection(vtkAlgorithmOutput* light)
{
  this->SetInputConnection(UNCOLLIDED, light);
}

void vtkScatteringSolver::SetUncollidedLightData(vtkDataObject* light)
{
  this->SetInputDataObject(UNCOLLIDED, light);
}

void vtkScatteringSolver::RemoveUncollidedLight()
{
  this->SetInputConnection(UNCOLLIDED, nullptr);
}

int vtkScatteringSolver::FillOutputPortInformation(int port, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkImageData" : "vtkTable");
  return 1;
}

tyndall::IlluminationInput vtkScatteringSolver::ReadShining(vtkInformationVector** inputs, bool emits)
{
  vtkImageData* const given = vtkImageData::GetData(inputs[UNCOLLIDED]);
  if (!given)
  {
    return this->ReadAllIllumination(inputs, emits);
  }
  tyndall::IlluminationInput input;
  input.uncollided = tyndall::ReadUncollided(given, tyndall::GridOf(vtkImageData::GetData(inputs[MEDIUM])));
  input.illumination.uncollided = input.uncollided.image;
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

int vtkScatteringSolver::GiveOrSolve(vtkInformation* request, vtkInformationVector** given,
  vtkInformationVector* outputs, const std::function<void(vtkInformationVector** inputs)>& solve)
{
  const tyndall::WorkOnPieces onPieces = { MEDIUM,
    [&](vtkMultiProcessController* ranks, vtkInformationVector** inputs) {
      return this->GiveOrSolvePiece(request, ranks, inputs, outputs);
    } };
  const int done = tyndall::Guarded(this, request, given, outputs, onPieces, [&](vtkInformationVector** inputs) {
    if (this->Solved->GiveBack(this->Superclass::GetMTime(), inputs, this->GetNumberOfInputPorts(), outputs))
    {
      this->HandOn(inputs, outputs);
      return;
    }
    this->Note({});
    solve(inputs);
  });
  if (tyndall::AreEmptied(outputs))
  {
    this->Note({});
  }
  return done;
}

/// Without WHOLE, whether this rank would have each solve its piece; ranks may differ in it.
bool vtkScatteringSolver::WantsBlocks(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) const
{
  return this->Decomposition == AUTOMATIC_DECOMPOSITION ? this->NotByAnyBlocks(inputs).empty() &&
      tyndall::NeedsPieces(request, inputs[MEDIUM], outputs, this->BytesOfVoxel())
                                                        : this->Decomposition == BLOCKS;
}

int vtkScatteringSolver::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bool asPiece = tyndall::EachAsksForItsPiece(request, outputs) && this->WantsBlocks(request, inputs, outputs);
  tyndall::AskForAllBut(asPiece ? MEDIUM : -1, request, inputs, this->GetNumberOfInputPorts(), outputs);
  return 1;
}

/// What keeps solvers of all kinds from solving pieces, or this one.
std::string vtkScatteringSolver::NotByAnyBlocks(vtkInformationVector** inputs) const
{
  const std::pair<bool, const char*> reasons[] = {
    { this->Quality != USUAL, "a Quality that chooses settings from the whole medium" },
    { this->Preview, "Preview" },
    { this->EstimateError, "EstimateError" },
    { this->MemoryBudget > 0, "MemoryBudget" },
    { this->LitColor, "LitColor" },
    { inputs[UNCOLLIDED]->GetNumberOfInformationObjects() > 0, "UncollidedLight" },
  };
  const auto found =
    std::find_if(std::begin(reasons), std::end(reasons), [](const auto& reason) { return reason.first; });
  const std::string ofSolver = this->NotByBlocks(inputs);
  return !ofSolver.empty() || found == std::end(reasons) ? ofSolver : found->second;
}

/// @return false, on all ranks, where each is to solve the whole
bool vtkScatteringSolver::GiveOrSolvePiece(vtkInformation* request, vtkMultiProcessController* ranks,
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkImageData* const image = vtkImageData::GetData(inputs[MEDIUM]);
  const std::optional<tyndall::AgreedBlocks> agreed = tyndall::AgreeOnBlocks(
    ranks, this, this->WantsBlocks(request, inputs, outputs), tyndall::AskingPort(request, outputs), image);
  if (!agreed)
  {
    return false;
  }
  tyndall::Communicator& communicator = *agreed->communicator;
  const tyndall::PieceBlocks& pieces = *agreed->pieces;
  if (this->GivePiece(communicator, pieces, inputs, outputs))
  {
    return true;
  }
  this->Note({});
  const tyndall::PieceOfMedium piece(communicator, pieces, this, image);
  tyndall::IlluminationInput shining;
  std::string refused;
  communicator.Together([&] {
    refused = this->NotByAnyBlocks(inputs);
    shining = this->ReadAllIllumination(inputs, piece.emits);
    const std::string ofScene = this->NotInBlocks(piece, shining);
    refused = refused.empty() ? ofScene : refused;
    tyndall::Require(refused.empty() || this->Decomposition != BLOCKS,
      "Ranks cannot solve their pieces (Decomposition: blocks) with " + refused +
        ". Leave it out, or let each rank solve the whole.");
  });
  if (communicator.Largest({ refused.empty() ? 0.0 : 1.0 })[0] > 0.0)
  {
    return false;
  }
  this->WarnWhereDark(shining.illumination, piece.emits);
  tyndall::LightField light = this->SolvePiece(communicator, pieces, piece, shining);
  TellOfDefaultSky(shining, light.leftOut);
  this->Note(light);
  this->WritePiece(communicator, pieces, std::move(light), inputs, outputs);
  return true;
}

/// The last light of this rank's block, where on no rank anything has changed. All ranks call it.
/// @return whether the outputs are there
bool vtkScatteringSolver::GivePiece(tyndall::Communicator& communicator, const tyndall::PieceBlocks& pieces,
  vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bool kept =
    this->Solved->GiveBack(this->Superclass::GetMTime(), inputs, this->GetNumberOfInputPorts(), outputs);
  const vtkIdType cells = vtkImageData::GetData(outputs, 0)->GetNumberOfCells();
  const bool same = kept && cells == static_cast<vtkIdType>(pieces.Held().VoxelCount());
  const bool onAll = communicator.Largest({ same ? 0.0 : 1.0 })[0] == 0.0;
  if (kept && !onAll)
  {
    this->Solved->Forget();
  }
  return onAll;
}

/// WriteSolved of the light of this rank's block. All ranks call it.
void vtkScatteringSolver::WritePiece(tyndall::Communicator& communicator, const tyndall::PieceBlocks& pieces,
  tyndall::LightField&& light, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  pieces.SpreadToHeld(communicator, light.fluence, light.channels);
  pieces.SpreadToHeld(communicator, light.fluenceDirect, light.channels);
  pieces.SpreadToHeld(communicator, light.netFlux, 3 * light.channels);
  pieces.SpreadToHeld(communicator, light.scatteredRadiance, light.channels);
  const std::size_t voxels = std::max<std::size_t>(pieces.Own().VoxelCount(), 1);
  const std::vector<double> ofMoments =
    communicator.Largest({ 1.0 * static_cast<double>(light.scatteredMoments.size() / voxels),
      1.0 * static_cast<double>(light.straightOn.size() / voxels) }); // a rank without voxels does not know
  pieces.SpreadToHeld(communicator, light.scatteredMoments, static_cast<int>(ofMoments[0]));
  pieces.SpreadToHeld(communicator, light.straightOn, static_cast<int>(ofMoments[1]));
  for (const std::string& doubt : Write(std::move(light), vtkImageData::GetData(inputs[MEDIUM]), outputs, &pieces))
  {
    vtkWarningMacro(<< doubt);
  }
  this->Solved->Keep(outputs);
}

void vtkScatteringSolver::WriteSolved(
  tyndall::LightField&& light, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  for (const std::string& doubt : Write(std::move(light), vtkImageData::GetData(inputs[MEDIUM]), outputs, nullptr))
  {
    vtkWarningMacro(<< doubt);
  }
  this->Solved->Keep(outputs);
  this->HandOn(inputs, outputs);
}

/// What is made of the light of the whole image, and the piece that was asked for.
void vtkScatteringSolver::HandOn(vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkImageData* const output = vtkImageData::GetData(outputs, 0);
  if (this->LitColor)
  {
    const tyndall::MediumInput input = tyndall::ReadMedium(this, vtkImageData::GetData(inputs[MEDIUM]));
    const tyndall::FloatField fluence = tyndall::ReadCells(output, "fluence", tyndall::Need::Required);
    tyndall::ToneMapping tones;
    tones.exposure = this->Exposure;
    tones.curve = static_cast<tyndall::ToneCurve>(this->ToneCurve);
    tyndall::WriteLitColor(tyndall::ColorLitMedium(input.medium, fluence, tones), output);
  }
  tyndall::KeepWhatIsAskedFor(outputs->GetInformationObject(0), output);
}

void vtkScatteringSolver::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Decomposition: " << this->Decomposition << "\n";
  os << indent << "Quality: " << this->Quality << "\n";
  os << indent << "Preview: " << this->Preview << "\n";
  os << indent << "MemoryBudget: " << this->MemoryBudget << "\n";
  os << indent << "SettingsUsed: " << this->SettingsUsed << "\n";
  os << indent << "LitColor: " << this->LitColor << "\n";
  os << indent << "Exposure: " << this->Exposure << "\n";
  os << indent << "ToneCurve: " << this->ToneCurve << "\n";
}
