#include "Ranks/Ranks.h"

#include "Common/Failure.h"

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
#include <array>
#include <functional>
#include <numeric>
#include <string>
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

vtkInformationIntegerKey* Together()
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

/// Pieces that are asked for, or ranks that ask together; 1: neither.
int Asking(vtkInformation* request, vtkInformationVector* outputs)
{
  const int port = std::max(request->Get(vtkExecutive::FROM_OUTPUT_PORT()), 0); // -1: no port, but the filter itself
  vtkInformation* const asking = outputs->GetInformationObject(port);
  return asking ? std::max({ 1, asking->Get(Pipeline::UPDATE_NUMBER_OF_PIECES()), asking->Get(Together()) }) : 1;
}

/// What a rank tells the others of how its work ended.
struct Told
{
  int kind = Ending::Done;
  int length = 0; ///< of the words
  int words = 0;  ///< a number that other words hardly have, too
  int sent = 0;   ///< whether it told the others to stop
};

std::vector<Told> TellAll(vtkMultiProcessController* controller, const Ending& own, bool sent)
{
  const std::array<int, 4> mine = { own.kind, static_cast<int>(own.why.size()),
    static_cast<int>(std::hash<std::string>()(own.why)), sent };
  std::vector<int> numbers(4 * static_cast<std::size_t>(controller->GetNumberOfProcesses()));
  controller->AllGather(mine.data(), numbers.data(), 4);
  std::vector<Told> all;
  for (std::size_t i = 0; i < numbers.size(); i += 4)
  {
    all.push_back({ numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3] });
  }
  return all;
}

/// The words of one rank, on all of them.
std::string Words(vtkMultiProcessController* controller, const Ending& own, const std::vector<Told>& all, int rank)
{
  const Told& told = all[static_cast<std::size_t>(rank)];
  std::string words = own.why;
  words.resize(static_cast<std::size_t>(told.length));
  controller->Broadcast(words.data(), told.length, rank);
  const bool alike = std::all_of(
    all.begin(), all.end(), [&](const Told& other) { return other.kind == told.kind && other.words == told.words; });
  return alike ? words : "On rank " + std::to_string(rank) + ": " + words;
}

/// @return how the work of all ranks together ended: as the worst of them
Ending Agreed(vtkMultiProcessController* controller, const Ending& own, const std::vector<Told>& all)
{
  const auto worst =
    std::max_element(all.begin(), all.end(), [](const Told& a, const Told& b) { return a.kind < b.kind; });
  const int rank = static_cast<int>(worst - all.begin());
  Ending ending;
  ending.kind = static_cast<Ending::Kind>(worst->kind);
  if (ending.kind == Ending::Failed)
  {
    ending.why = Words(controller, own, all, rank);
  }
  else if (ending.kind == Ending::InputFailed && own.kind != Ending::InputFailed)
  {
    ending.kind = Ending::Failed;
    ending.why = "The filter before failed on rank " + std::to_string(rank) + ", which says why.";
  }
  return ending;
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
  void Receive(const std::vector<Told>& all)
  {
#ifdef TYNDALL_HAS_MPI
    if (this->Controller)
    {
      this->ForOthers([&](int rank) {
        if (int stop = 0; all[static_cast<std::size_t>(rank)].sent)
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
    (void)all;
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
    inputs->GetInformationObject(i)->Set(Together(), asking);
  }
}

vtkMultiProcessController* RanksTogether(vtkInformation* request, vtkInformationVector* outputs)
{
  vtkMultiProcessController* const all = vtkMultiProcessController::GetGlobalController();
  return !IsOne(all) && Asking(request, outputs) == all->GetNumberOfProcesses() ? all : nullptr;
}

void OnAllRanks(vtkMultiProcessController* controller, const std::function<void()>& act)
{
  const Ending own = EndingOf(act);
  Throw(IsOne(controller) ? own : Agreed(controller, own, TellAll(controller, own, false)));
}

void WorkOnAllRanks(vtkMultiProcessController* controller, vtkAlgorithm* filter, const std::function<void()>& work)
{
  if (IsOne(controller))
  {
    Throw(EndingOf(work));
    return;
  }
  StopMessages messages(controller);
  vtkObjectBase* const before = filter->GetInformation()->Get(WorkingRanks()); // of work of which this is a part
  filter->GetInformation()->Set(WorkingRanks(), controller);
  const Ending own = EndingOf(work);
  filter->GetInformation()->Set(WorkingRanks(), before);
  const bool sent = own.kind != Ending::Done && !messages.Waits() && messages.Send();
  const std::vector<Told> all = TellAll(controller, own, sent);
  messages.Receive(all);
  Throw(Agreed(controller, own, all));
}

bool IsStoppedByOthers(vtkAlgorithm* filter)
{
  auto* const controller = vtkMultiProcessController::SafeDownCast(filter->GetInformation()->Get(WorkingRanks()));
  return controller && StopMessages(controller).Waits();
}
}
