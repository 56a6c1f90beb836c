#include "Ranks/Ranks.h"

#include "Common/Failure.h"
#include "Device/Errors.h"
#include "Ranks/ControllerCommunicator.h"
#include "Ranks/WholeImage.h"

#include "vtkAlgorithm.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationObjectBaseKey.h"
#include "vtkInformationVector.h"
#include "vtkMultiProcessController.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#ifdef TYNDALL_HAS_MPI
#include "vtkMPIController.h"
#endif

#include <algorithm>
#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
namespace
{
using Pipeline = vtkStreamingDemandDrivenPipeline;

constexpr int StopTag = 745202; ///< of a message: stop the work

/// A request's number of ranks that ask together, which goes upstream through all filters.
class TogetherKey : public vtkInformationIntegerKey
{
public:
  vtkTypeMacro(TogetherKey, vtkInformationIntegerKey);

  TogetherKey()
    : vtkInformationIntegerKey("RANKS_TOGETHER", "Tyndall")
  {
  }

  void CopyDefaultInformation(vtkInformation* request, vtkInformation* from, vtkInformation* to) override
  {
    if (request->Has(Pipeline::REQUEST_UPDATE_EXTENT()))
    {
      this->ShallowCopy(from, to);
    }
  }
};

vtkInformationIntegerKey* Collective()
{
  static auto* const key = new TogetherKey; // VTK deletes it
  return key;
}

/// Of a filter's own information while it works: the controller of the ranks that do.
vtkInformationObjectBaseKey* WorkingRanks()
{
  static auto* const key = vtkInformationObjectBaseKey::MakeKey("WORKING_RANKS", "Tyndall");
  return key;
}

int PiecesAsked(vtkInformation* request, vtkInformationVector* outputs)
{
  vtkInformation* const asking = AskingPort(request, outputs);
  return asking ? std::max(1, asking->Get(Pipeline::UPDATE_NUMBER_OF_PIECES())) : 1;
}

/// Pieces that are asked for, or ranks that ask together; 1: neither.
int Asking(vtkInformation* request, vtkInformationVector* outputs)
{
  vtkInformation* const asking = AskingPort(request, outputs);
  return asking ? std::max(PiecesAsked(request, outputs), asking->Get(Collective())) : 1;
}

/// Makes how one rank ended that of all.
void EndTogether(Communicator& communicator, const Ending& own)
{
  try
  {
    communicator.Collective([&] {
      Require(own.kind != Ending::InputFailed, "The filter before failed, and says why there.");
      Require(own.kind != Ending::Empty, "The input image is empty.");
      Throw(own);
    });
  }
  catch (const InvalidInput&)
  {
    if (own.kind == Ending::InputFailed || own.kind == Ending::Empty)
    {
      Throw(own); // which is no error of this filter here
    }
    throw;
  }
}

bool IsOne(vtkMultiProcessController* controller)
{
  return controller == nullptr || controller->GetNumberOfProcesses() == 1;
}

/// Messages that tell other ranks to stop: few, and all received before the ranks part.
class StopMessages
{
public:
  explicit StopMessages(vtkMultiProcessController* controller)
#ifdef TYNDALL_HAS_MPI
    : Controller(vtkMPIController::SafeDownCast(controller))
#endif
  {
    (void)controller;
  }

  /// Whether one is waiting for this rank.
  bool Waits() const
  {
    int waits = 0;
#ifdef TYNDALL_HAS_MPI
    if (this->Controller)
    {
      int from = 0;
      this->Controller->Iprobe(vtkMultiProcessController::ANY_SOURCE, StopTag, &waits, &from);
    }
#endif
    return waits != 0;
  }

  /// @return whether they were sent: without MPI nobody could look for them
  bool Send()
  {
#ifdef TYNDALL_HAS_MPI
    if (this->Controller)
    {
      this->ForOthers([this](int rank) {
        this->Requests.emplace_back();
        this->Controller->NoBlockSend(&this->Stop, 1, rank, StopTag, this->Requests.back());
      });
      return true;
    }
#endif
    return false;
  }

  /// Receives those that other ranks sent.
  /// @param senders  by rank, greater than 0 where it did
  void Receive(const std::vector<double>& senders)
  {
#ifdef TYNDALL_HAS_MPI
    if (this->Controller)
    {
      this->ForOthers([&](int rank) {
        if (int stop = 0; senders[static_cast<std::size_t>(rank)] > 0.0)
        {
          this->Controller->Receive(&stop, 1, rank, StopTag);
        }
      });
      for (vtkMPICommunicator::Request& request : this->Requests)
      {
        request.Wait();
      }
    }
#endif
    (void)senders;
  }

private:
#ifdef TYNDALL_HAS_MPI
  template <typename Do>
  void ForOthers(const Do& act)
  {
    for (int rank = 0; rank < this->Controller->GetNumberOfProcesses(); ++rank)
    {
      if (rank != this->Controller->GetLocalProcessId())
      {
        act(rank);
      }
    }
  }

  vtkMPIController* Controller;
  std::vector<vtkMPICommunicator::Request> Requests;
  int Stop = 1;
#endif
};
}

void AskTogether(vtkInformation* request, vtkInformationVector* outputs, vtkInformationVector* inputs)
{
  const int asking = Asking(request, outputs);
  for (int i = 0; i < inputs->GetNumberOfInformationObjects(); ++i)
  {
    vtkInformation* const input = inputs->GetInformationObject(i);
    input->Set(Collective(), asking);
    // An output with voxels around points, or with axes in another order, is asked for more than its input has.
    const int* const whole = input->Get(Pipeline::WHOLE_EXTENT());
    const int* const asked = input->Get(Pipeline::UPDATE_EXTENT());
    if (whole && asked && !Covers(whole, asked))
    {
      const std::vector<int> within(whole, whole + 6);
      input->Set(Pipeline::UPDATE_EXTENT(), within.data(), 6);
    }
  }
}

vtkMultiProcessController* RanksTogether(vtkInformation* request, vtkInformationVector* outputs)
{
  vtkMultiProcessController* const all = vtkMultiProcessController::GetGlobalController();
  return !IsOne(all) && Asking(request, outputs) == all->GetNumberOfProcesses() ? all : nullptr;
}

bool EachAsksForItsPiece(vtkInformation* request, vtkInformationVector* outputs)
{
  vtkMultiProcessController* const all = vtkMultiProcessController::GetGlobalController();
  return !IsOne(all) && PiecesAsked(request, outputs) == all->GetNumberOfProcesses();
}

void OnAllRanks(vtkMultiProcessController* controller, const std::function<void()>& act)
{
  const Ending own = EndingOf(act);
  const auto stopped = [controller] { return StopMessages(controller).Waits(); };
  EndTogether(*CommunicatorOf(IsOne(controller) ? nullptr : controller, stopped), own);
}

void WorkOnAllRanks(vtkMultiProcessController* controller, vtkAlgorithm* filter, const std::function<void()>& work)
{
  if (IsOne(controller))
  {
    Throw(EndingOf(work));
    return;
  }
  StopMessages messages(controller);
  BeginConversations();
  vtkObjectBase* const before = filter->GetInformation()->Get(WorkingRanks()); // of work of which this is a part
  filter->GetInformation()->Set(WorkingRanks(), controller);
  const Ending own = EndingOf(work);
  filter->GetInformation()->Set(WorkingRanks(), before);
  const bool sent = own.kind != Ending::Done && !messages.Waits() && messages.Send();
  const std::unique_ptr<Communicator> communicator = CommunicatorAtEnd(controller);
  std::vector<double> senders(static_cast<std::size_t>(communicator->Ranks()), 0.0);
  senders[static_cast<std::size_t>(communicator->Rank())] = sent ? 1.0 : 0.0;
  messages.Receive(communicator->Sum(senders));
  EndTogether(*communicator, own);
}

bool IsStoppedByOthers(vtkAlgorithm* filter)
{
  auto* const controller = vtkMultiProcessController::SafeDownCast(filter->GetInformation()->Get(WorkingRanks()));
  return controller && StopMessages(controller).Waits();
}
}
