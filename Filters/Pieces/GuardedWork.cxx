#include "Pieces/GuardedWork.h"

// LightTransportData.h shows how filters use Guarded.
#include "Common/Failure.h"
#include "Common/ImageInput.h"
#include "Common/InputsKey.h"
#include "Common/LightTransportWriting.h"
#include "Device/Clock.h"
#include "Device/Device.h"
#include "Pieces/ControllerCommunicator.h"
#include "Pieces/GatheredImage.h"
#include "Pieces/PieceBlocks.h"
#include "Pieces/Ranks.h"
#include "Pieces/UpdateExtent.h"
#include "Pieces/WholeInputs.h"
#include "PropertyRange.h"

#include "vtkAlgorithm.h"
#include "vtkCommunicator.h"
#include "vtkDataObject.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationDoubleKey.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationUnsignedLongKey.h"
#include "vtkInformationVector.h"
#include "vtkMatrix3x3.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkTimeStamp.h"
#include "vtkVersionMacros.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <string>

namespace tyndall
{
namespace
{
/// Record of when and how a filter's last run failed, to avoid reporting the same error repeatedly. VTK runs a filter
/// again on every update as long as its output does not cover the requested extent. Empty outputs never do, and
/// ParaView makes several updates.
class LastFailure
{
public:
  enum Kind
  {
    Error,
    Abort,
    Information, ///< an error in RequestInformation
    Missing,     ///< a rank did not reach the filter
  };

  explicit LastFailure(vtkAlgorithm* filter)
    : Filter(filter)
    , Facts(filter->GetInformation())
  {
  }

  bool StillHolds() const
  {
    auto* pipeline = vtkDemandDrivenPipeline::SafeDownCast(this->Filter->GetExecutive());
    const vtkMTimeType time = this->Facts->Has(Time()) ? this->Facts->Get(Time()) : 0;
    // The filter's own modification time counts too, because ParaView's reader for series of files bypasses the
    // pipeline.
    bool holds = pipeline && std::max(pipeline->GetPipelineMTime(), this->Filter->GetMTime()) < time;
    for (int port = 0; holds && port < this->Filter->GetNumberOfInputPorts(); ++port)
    {
      for (int i = 0; holds && i < this->Filter->GetNumberOfInputConnections(port); ++i)
      {
        holds = TimeOf(this->Filter->GetInputDataObject(port, i)) < time;
      }
    }
    return holds;
  }

  bool Was(Kind kind) const { return this->Facts->Has(Time()) && this->Facts->Get(How()) == kind; }

  void Note(Kind kind)
  {
    vtkTimeStamp now;
    now.Modified();
    this->Facts->Set(Time(), now.GetMTime());
    this->Facts->Set(How(), kind);
  }

  void Forget() { this->Facts->Remove(Time()); }

private:
  /// Latest modification time of the arrays of a data object. The time of the data object itself is not useful:
  /// ParaView's internal filters make the object anew, with the same arrays, on every access.
  static vtkMTimeType TimeOf(vtkDataObject* data)
  {
    const std::vector<vtkMTimeType> times = TimesOfArrays(data);
    return times.empty() ? 0 : *std::max_element(times.begin(), times.end());
  }

  static vtkInformationUnsignedLongKey* Time()
  {
    static auto* const key = vtkInformationUnsignedLongKey::MakeKey("FAILURE_TIME", "Tyndall");
    return key;
  }

  static vtkInformationIntegerKey* How()
  {
    static auto* const key = vtkInformationIntegerKey::MakeKey("FAILURE_KIND", "Tyndall");
    return key;
  }

  vtkAlgorithm* Filter;
  vtkInformation* Facts;
};

/// Reports a filter's progress, a fraction from 0 to 1. Does nothing after an abort was requested.
void ReportProgress(vtkAlgorithm* filter, const char* text, double fractionDone)
{
  if (filter->GetAbortExecute() == 0)
  {
    filter->SetProgressText(text);
    filter->UpdateProgress(fractionDone);
  }
}
}

Monitor MonitorOf(vtkAlgorithm* filter)
{
  return [filter](double fractionDone) {
    ReportProgress(filter, nullptr, fractionDone);
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
    const bool aborted = filter->CheckAbort();
#else
    const bool aborted = filter->GetAbortExecute() != 0;
#endif
    return !aborted && !IsStoppedByOthers(filter);
  };
}

namespace
{
const char* const Compiling = "compiling kernels (once)";

void EmptyOutputs(vtkInformationVector* outputs, const char* why)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* output = vtkDataObject::GetData(outputs, port))
    {
      output->Initialize();
      AddFact(output, why, std::vector<double>{ 1.0 });
    }
  }
}

/// Resets a filter's two abort flags: newer versions of VTK leave them set and would run the filter again on every
/// update.
void ForgetAbort(vtkAlgorithm* filter)
{
  filter->AbortExecute = 0;
#if VTK_VERSION_NUMBER >= VTK_VERSION_CHECK(9, 2, 20220823)
  filter->SetAbortOutput(false);
#endif
}
}

namespace
{
/// Issues the device layer's warnings, once per process, as warnings of the filter that opened the device.
void WarnOfDevices(vtkAlgorithm* filter)
{
  for (const std::string& warning : Device::TakeWarnings())
  {
    vtkWarningWithObjectMacro(filter, << warning);
  }
}
}

namespace
{
void EmptyWithout(vtkInformationVector* outputs)
{
  EmptyOutputs(outputs, FailedFact);
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    if (vtkDataObject* output = vtkDataObject::GetData(outputs, port))
    {
      AddFact(output, MissingFact, std::vector<double>{ 1.0 });
    }
  }
}

/// Whether a rank is known to be missing: it did not reach this filter in the last run and nothing has changed since,
/// or it did not reach a filter upstream.
bool IsKnownToMiss(vtkAlgorithm* filter, const LastFailure& last)
{
  bool known = last.Was(LastFailure::Missing) && last.StillHolds();
  for (int port = 0; port < filter->GetNumberOfInputPorts(); ++port)
  {
    for (int i = 0; i < filter->GetNumberOfInputConnections(port); ++i)
    {
      vtkDataObject* const input = filter->GetInputDataObject(port, i);
      known = known || (input && input->GetFieldData()->HasArray(MissingFact));
    }
  }
  return known;
}

/// Reports the missing rank as an error, empties the outputs, and records the failure, so that later updates do not
/// wait for that rank.
void FailWithout(const MissingRank& missing, vtkAlgorithm* filter, vtkInformationVector* outputs, LastFailure& last)
{
  EmptyWithout(outputs);
  if (missing.elsewhere)
  {
    vtkErrorWithObjectMacro(filter, << "Rank " << missing.rank
                                    << " came to another filter than rank 0 (on this rank: " << filter->GetClassName()
                                    << "). Make the same pipeline on all ranks, and update it in the same order.");
  }
  else
  {
    vtkErrorWithObjectMacro(
      filter, << "Rank " << missing.rank << " did not come to this filter within " << SecondsToWait()
              << " seconds. All ranks have to update the same filters: look at the script, and for an "
                 "error of a filter before on that rank. If it only takes longer, set "
                 "TYNDALL_RANKS_WAIT (seconds).");
  }
  last.Note(LastFailure::Missing);
}

/// Whether nothing has changed on any rank since the last run failed. Collective.
bool StillHolds(vtkMultiProcessController* ranks, const LastFailure& last)
{
  int own = last.StillHolds(), all = own;
  if (ranks)
  {
    ranks->AllReduce(&own, &all, 1, vtkCommunicator::MIN_OP);
  }
  return all != 0;
}

/// Key in a filter's information: its last run returned cached outputs of an earlier run (LastOutputs).
vtkInformationIntegerKey* GivenBack()
{
  static auto* const key = vtkInformationIntegerKey::MakeKey("GIVEN_BACK", "Tyndall");
  return key;
}

/// Sets the properties Seconds and, after a failure, LeftOut.
void NoteRun(vtkAlgorithm* filter, bool succeeded, double seconds)
{
  if (!succeeded)
  {
    NoteSeconds(filter, 0.0);
    NoteLeftOut(filter, "");
  }
  else if (!filter->GetInformation()->Has(GivenBack()))
  {
    NoteSeconds(filter, seconds);
  }
}

/// Sends the list of skipped computations, and whether the outputs were cached ones, from the first rank to the other
/// ranks. The first rank has worked alone. Collective.
void ShareRun(Communicator& ranks, vtkAlgorithm* filter)
{
  std::string leftOut = LeftOutOfRun(filter);
  bool givenBack = filter->GetInformation()->Has(GivenBack()) != 0;
  TakeFromFirstRank(ranks, leftOut, givenBack);
  NoteLeftOut(filter, leftOut);
  if (givenBack)
  {
    NoteGivenBack(filter);
  }
}

int GuardedOn(vtkMultiProcessController* ranks, vtkAlgorithm* filter, vtkInformationVector* outputs,
  const std::function<void()>& work)
{
  LastFailure last(filter);
  if (ranks && IsKnownToMiss(filter, last))
  {
    EmptyWithout(outputs);
    return 1;
  }
  if (const MissingRank missing = ranks ? FindMissingRank(ranks, filter->GetClassName()) : MissingRank();
      missing.rank >= 0)
  {
    FailWithout(missing, filter, outputs, last);
    return 1;
  }
  if (StillHolds(ranks, last))
  {
    EmptyOutputs(outputs, last.Was(LastFailure::Abort) ? AbortedFact : FailedFact);
    return 1;
  }
  last.Forget();
  const double start = ClockSeconds();
  // OpenCL's compiler cannot be interrupted: the listener shows that it runs, and an abort takes effect afterwards.
  const CompilationListener listener([filter] { ReportProgress(filter, Compiling, filter->GetProgress()); });
  filter->GetInformation()->Remove(GivenBack());
  const Ending ending = EndingOf([&] { WorkOnAllRanks(ranks, filter, work); });
  NoteRun(filter, ending.kind == Ending::Done, ClockSeconds() - start);
  if (ending.kind == Ending::Aborted)
  {
    EmptyOutputs(outputs, AbortedFact);
    ForgetAbort(filter);
    last.Note(LastFailure::Abort);
  }
  else if (ending.kind == Ending::Empty)
  {
    EmptyOutputs(outputs, EmptyFact);
  }
  else if (ending.kind != Ending::Done)
  {
    EmptyOutputs(outputs, FailedFact);
    if (ending.kind == Ending::Failed)
    {
      vtkErrorWithObjectMacro(filter, << ending.why);
    }
    last.Note(LastFailure::Error);
  }
  filter->SetProgressText(nullptr);
  WarnOfDevices(filter);
  return 1;
}
}

namespace
{
/// Adds the names of point arrays that were averaged to cells to field data `settings_used`, for filters that do not
/// write these field data themselves.
void TellAveraged(vtkAlgorithm* filter, vtkInformationVector* outputs)
{
  std::vector<std::string> settings;
  AddAveraged(filter, settings);
  vtkDataObject* const output = vtkDataObject::GetData(outputs, 0);
  if (output && !settings.empty() && !output->GetFieldData()->HasArray("settings_used"))
  {
    AddFact(output, "settings_used", settings);
  }
}
}

int Guarded(vtkAlgorithm* filter, vtkInformationVector* outputs, const std::function<void()>& work)
{
  return GuardedOn(nullptr, filter, outputs, [&] {
    RequireImages(filter);
    RequireWholeArrays(filter);
    CheckProperties(filter);
    CheckDuplicates(filter, outputs);
    work();
  });
}

namespace
{
/// Input ports of a filter whose data stay in pieces.
struct PortsInPieces
{
  int image = WholeInputs::NoPort, shares = WholeInputs::NoPort;
  std::vector<int> others = {};
};

int GuardedWithInputs(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given,
  vtkInformationVector* outputs, const PortsInPieces& ports,
  const std::function<void(vtkMultiProcessController* ranks, WholeInputs& inputs)>& work)
{
  vtkMultiProcessController* const ranks = RanksTogether(request, outputs);
  return GuardedOn(ranks, filter, outputs, [&] {
    OnAllRanks(ranks, [&] {
      RequireImages(filter);
      RequireWholeArrays(filter);
      CheckProperties(filter);
      // With several ranks, WholeInputs takes each cell from the rank that owns it, so that duplicates do no harm
      if (!ranks)
      {
        CheckDuplicates(filter, outputs);
      }
    });
    WholeInputs inputs(ranks, filter, given, outputs, ports.image, ports.shares, ports.others);
    work(ranks, inputs);
  });
}

/// Completes the outputs on this rank: adds the names of point arrays that were averaged to cells, and rotates images
/// back to the scene axes.
void Complete(vtkAlgorithm* filter, WholeInputs& inputs, vtkInformationVector* outputs)
{
  TellAveraged(filter, outputs);
  inputs.PutIntoScene(outputs);
}
}

int Guarded(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs,
  const std::function<void(vtkInformationVector** inputs)>& work)
{
  return GuardedInPieces(filter, request, given, outputs, WholeInputs::NoPort,
    [&](vtkMultiProcessController*, WholeInputs& inputs) { work(inputs.Vectors()); });
}

int GuardedInPieces(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given,
  vtkInformationVector* outputs, int port,
  const std::function<void(vtkMultiProcessController* ranks, WholeInputs& inputs)>& work)
{
  return GuardedWithInputs(
    filter, request, given, outputs, { port }, [&](vtkMultiProcessController* ranks, WholeInputs& inputs) {
      work(ranks, inputs);
      Complete(filter, inputs, outputs);
    });
}

namespace
{
constexpr int PartTag = 745205; ///< tag of messages with parts of outputs

/// Whether the extent of the image at an output port is unknown until the work is done.
bool TellsExtent(const WorkOnSubdomains& work, int port)
{
  return work.tellsExtents || port > 0;
}

/// Crops complete output images to the parts that are requested from this rank.
void KeepParts(const WorkOnSubdomains& work, vtkInformation* asking, vtkInformationVector* outputs)
{
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkImageData* const output = vtkImageData::GetData(outputs, port);
    const bool tells = TellsExtent(work, port);
    if (output && (output->GetNumberOfCells() > 0 || !tells))
    {
      vtkInformation* const information = outputs->GetInformationObject(port);
      if (tells)
      {
        TellExtent(asking, information, output->GetExtent());
      }
      KeepWhatIsAskedFor(information, output);
    }
  }
}

/// Sends to each rank the requested part of an image that the first rank made. Collective.
void DistributeImage(vtkMultiProcessController* ranks, const WorkOnSubdomains& work, vtkInformation* asking,
  vtkInformationVector* outputs, int port)
{
  using Extent = std::array<int, 6>;
  vtkImageData* const output = vtkImageData::GetData(outputs, port);
  const bool isFirst = ranks->GetLocalProcessId() == 0;
  Extent whole;
  std::array<double, 9> direction;
  output->GetExtent(whole.data());
  std::copy_n(output->GetDirectionMatrix()->GetData(), 9, direction.begin());
  ranks->Broadcast(whole.data(), 6, 0);
  ranks->Broadcast(direction.data(), 9, 0);
  const auto isEmpty = [](const int* extent) {
    return extent[0] > extent[1] || extent[2] > extent[3] || extent[4] > extent[5];
  };
  if (isEmpty(whole.data()))
  {
    return;
  }
  vtkInformation* const information = outputs->GetInformationObject(port);
  if (TellsExtent(work, port))
  {
    TellExtent(asking, information, whole.data());
  }
  const Extent own = ExtentAskedFor(information, whole);
  std::vector<int> asked(6 * static_cast<std::size_t>(ranks->GetNumberOfProcesses()));
  ranks->AllGather(own.data(), asked.data(), 6);
  for (int rank = 1; rank < ranks->GetNumberOfProcesses(); ++rank)
  {
    int* const extent = asked.data() + 6 * rank;
    if (isEmpty(extent))
    {
      continue;
    }
    vtkNew<vtkImageData> part;
    OnAllRanks(ranks, [&] {
      if (isFirst)
      {
        part->ShallowCopy(output);
        part->Crop(extent);
      }
    });
    if (isFirst)
    {
      ranks->Send(part, rank, PartTag);
    }
    else if (ranks->GetLocalProcessId() == rank)
    {
      ranks->Receive(part, 0, PartTag);
      part->SetDirectionMatrix(direction.data()); // VTK does not send the direction matrix
      output->ShallowCopy(part);
    }
  }
  KeepWhatIsAskedFor(information, output, whole);
}

/// Works on the complete inputs on the first rank, which then distributes the outputs. Collective.
void WorkOnWhole(vtkMultiProcessController* ranks, vtkAlgorithm* filter, vtkInformation* asking,
  vtkInformationVector* outputs, const WorkOnSubdomains& work, WholeInputs& inputs)
{
  const auto workOnAll = [&] {
    work.work(PieceBlocks(vtkImageData::GetData(inputs.Vectors()[work.port])), inputs.Vectors());
    Complete(filter, inputs, outputs);
  };
  if (!ranks || work.wholeOnEachRank)
  {
    inputs.MakeWhole();
    workOnAll();
    KeepParts(work, asking, outputs);
    return;
  }
  const bool isFirst = ranks->GetLocalProcessId() == 0;
  inputs.MakeWhole(GatheredImage::On::FirstRank);
  OnFirstRank(ranks, workOnAll);
  const std::unique_ptr<Communicator> all = CommunicatorOf(ranks, [filter] { return IsStoppedByOthers(filter); });
  ShareRun(*all, filter);
  if (work.shareResults)
  {
    work.shareResults(*all);
  }
  for (int port = 0; port < outputs->GetNumberOfInformationObjects(); ++port)
  {
    vtkDataObject* const output = vtkDataObject::GetData(outputs, port);
    if (vtkImageData::SafeDownCast(output))
    {
      DistributeImage(ranks, work, asking, outputs, port);
    }
    else if (port > 0 && output->IsA("vtkTable"))
    {
      ranks->Broadcast(output, 0);
    }
    vtkDataObject* const input = vtkDataObject::GetData(inputs.Vectors()[work.port]);
    if (!isFirst && input)
    {
      output->GetInformation()->CopyEntry(input->GetInformation(), vtkDataObject::DATA_TIME_STEP());
    }
  }
}
}

int Guarded(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs,
  const WorkOnSubdomains& work)
{
  const auto run = [&](vtkMultiProcessController* ranks, WholeInputs& inputs) {
    vtkInformation* const asking = AskingPort(request, outputs);
    std::optional<AgreedBlocks> agreed;
    if (ranks)
    {
      const bool wants = work.wantsPieces && work.wantsPieces(inputs.Vectors());
      agreed = AgreeOnBlocks(ranks, filter, wants, asking, vtkImageData::GetData(inputs.Vectors()[work.port]));
    }
    if (!agreed || !work.work(*agreed->pieces, inputs.Vectors()))
    {
      WorkOnWhole(ranks, filter, asking, outputs, work, inputs);
      return;
    }
    Complete(filter, inputs, outputs);
    if (work.tellsExtents)
    {
      KeepParts(work, asking, outputs);
    }
  };
  return GuardedWithInputs(filter, request, given, outputs, { work.port, work.shares, work.others }, run);
}

void NoteGivenBack(vtkAlgorithm* filter)
{
  filter->GetInformation()->Set(GivenBack(), 1);
}

bool AreEmptied(vtkInformationVector* outputs)
{
  vtkDataObject* const output = vtkDataObject::GetData(outputs, 0);
  return output && (output->GetFieldData()->HasArray(FailedFact) || output->GetFieldData()->HasArray(AbortedFact));
}

bool GuardedInformation(vtkAlgorithm* filter, const std::function<void()>& work)
{
  LastFailure last(filter);
  try
  {
    if (filter->GetNumberOfInputPorts() == 0) // if there are inputs, Guarded checks the properties
    {
      CheckProperties(filter);
    }
    work();
  }
  catch (const std::exception& error)
  {
    if (!last.Was(LastFailure::Information) || !last.StillHolds())
    {
      vtkErrorWithObjectMacro(filter, << error.what());
    }
    last.Note(LastFailure::Information);
    return false;
  }
  if (last.Was(LastFailure::Information))
  {
    last.Forget();
  }
  return true;
}
}
