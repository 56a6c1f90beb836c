#include "vtkPhotonEmitter.h"

#include "Common/LightTransportData.h"
#include "Common/PrintMembers.h"
#include "Photons/PhotonData.h"
#include "Pieces/ControllerCommunicator.h"
#include "Pieces/GuardedWork.h"
#include "Pieces/PieceBlocks.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"
#include "Pieces/WholeInputs.h"

#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

vtkStandardNewMacro(vtkPhotonEmitter);

vtkPhotonEmitter::vtkPhotonEmitter()
{
  const tyndall::EmissionSettings defaults;
  this->MaximumDensity = defaults.densestAtMost;
  this->SetNumberOfInputPorts(4);
}

vtkPhotonEmitter::~vtkPhotonEmitter() = default;

vtkPolyData* vtkPhotonEmitter::GetOutput()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(0));
}

/// Declares the medium's arrays as read, although the emitter reads none. The emitter then places voxels around points,
/// or between points, as the filters do that read these arrays (PointData).
int vtkPhotonEmitter::FillInputPortInformation(int port, vtkInformation* information)
{
  const int done = this->Superclass::FillInputPortInformation(port, information);
  if (port == MEDIUM)
  {
    tyndall::ReadsVoxels(information, { "sigma_a", "sigma_s", "emission", "ior" }, { tyndall::AnyArray });
  }
  if (port == IMPORTANCE_MAP)
  {
    tyndall::TakePictures(information);
    tyndall::ReadsVoxels(information, {}, { "importance" });
  }
  return done;
}

int vtkPhotonEmitter::FillOutputPortInformation(int, vtkInformation* information)
{
  information->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkPolyData");
  return 1;
}

/// Requests only this rank's piece of the medium if each rank is asked for its own piece; RequestData then finds the
/// box of the whole medium from the pieces of all ranks.
int vtkPhotonEmitter::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const bool inPieces = tyndall::EachAsksForItsPiece(request, outputs);
  tyndall::AskForAllBut(inPieces ? MEDIUM : -1, request, inputs, this->GetNumberOfInputPorts(), outputs);
  return 1;
}

namespace
{
/// Grid of the whole medium, from the pieces of all ranks. Collective.
/// @param ranks  ranks that run the filter together; null: one rank
/// @param inputs  inputs of this rank; the medium is gathered on every rank if the pieces do not tile one grid
tyndall::Grid WholeGrid(vtkAlgorithm* filter, vtkMultiProcessController* ranks, tyndall::WholeInputs& inputs)
{
  const int port = vtkPhotonEmitter::MEDIUM;
  if (ranks)
  {
    const std::optional<tyndall::AgreedBlocks> agreed =
      tyndall::AgreeOnBlocks(ranks, filter, true, nullptr, vtkImageData::GetData(inputs.Vectors()[port]));
    if (agreed)
    {
      return agreed->pieces->Partition().whole;
    }
  }
  inputs.MakeWhole();
  return tyndall::GridOf(vtkImageData::GetData(inputs.Vectors()[port]));
}

/// Sets which part of the photons this rank emits: the part that corresponds to the requested piece. If any rank is
/// asked for all photons, every rank emits all photons: one complete set and parts on other ranks would together have
/// too much power. Collective.
/// @param others  the ranks that run the update together; null on one rank
void TellPart(vtkInformation* asking, tyndall::Communicator* others, tyndall::EmissionSettings& settings)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  const bool divided =
    asking->Has(Pipeline::UPDATE_PIECE_NUMBER()) && asking->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()) > 1;
  const bool whole = others && tyndall::OnAnyRank(*others, !divided);
  if (divided && !whole)
  {
    settings.part = asking->Get(Pipeline::UPDATE_PIECE_NUMBER());
    settings.parts = asking->Get(Pipeline::UPDATE_NUMBER_OF_PIECES());
  }
}
}

int vtkPhotonEmitter::RequestData(vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs)
{
  this->Photons = 0;
  std::fill_n(this->Power, 3, 0.0);
  const auto work = [&](vtkMultiProcessController* ranks, tyndall::WholeInputs& all) {
    const tyndall::Grid grid = WholeGrid(this, ranks, all);
    vtkInformationVector** const inputs = all.Vectors();
    tyndall::Illumination illumination = this->ReadIllumination(inputs);
    std::copy_n(this->SkyColor, 3, illumination.sky.begin());
    if (tyndall::NothingShines(illumination))
    {
      vtkWarningMacro(
        "Nothing shines on the volume, so there are no photons. Connect Lights or an Environment, or set SkyColor.");
    }
    vtkImageData* const mapped = vtkImageData::GetData(inputs[IMPORTANCE_MAP]);
    const tyndall::ImportanceMap map = tyndall::ReadImportanceMap(mapped, illumination);
    tyndall::EmissionSettings settings;
    const std::unique_ptr<tyndall::Communicator> others =
      ranks ? tyndall::CommunicatorOf(ranks, [this] { return tyndall::IsStoppedByOthers(this); }) : nullptr;
    TellPart(tyndall::AskingPort(request, outputs), others.get(), settings);
    settings.photonCount = static_cast<std::size_t>(this->PhotonCount);
    settings.sampler = static_cast<tyndall::Sampler>(this->Sampler);
    settings.seed = static_cast<std::uint64_t>(this->Seed);
    settings.batches = this->Batches != 0 ? this->Batches : mapped ? 2 : 1;
    settings.map = &map;
    settings.densestAtMost = this->MaximumDensity;
    tyndall::WorkOnAllRanks(ranks, this, [&] {
      const tyndall::EmittedPhotons emitted =
        tyndall::EmitPhotons(grid, illumination, settings, tyndall::MonitorOf(this));
      tyndall::WritePhotons(emitted, grid, tyndall::OwnAxesOf(this), vtkPolyData::GetData(outputs));
      tyndall::TellLeftOut(this, vtkPolyData::GetData(outputs), emitted.leftOut);
      this->Photons = static_cast<vtkIdType>(emitted.photons.size());
      std::copy_n(emitted.power.begin(), 3, this->Power);
    });
    if (others && settings.parts > 1)
    {
      const std::vector<double> sums =
        others->Sum({ this->Power[0], this->Power[1], this->Power[2], static_cast<double>(this->Photons) });
      std::copy_n(sums.begin(), 3, this->Power);
      this->Photons = static_cast<vtkIdType>(sums[3]);
    }
  };
  return tyndall::GuardedInPieces(this, request, given, outputs, MEDIUM, work);
}

void vtkPhotonEmitter::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  tyndallPrintMacro(PhotonCount, Sampler, Seed, Batches, MaximumDensity, SkyColor, Photons, Power);
  tyndall::PrintRun(os, indent, this);
}
