#include "Pieces/Ranks.h"

#include "Common/Failure.h"
#include "Device/Errors.h"
#include "Pieces/ControllerCommunicator.h"
#include "Pieces/UpdateExtent.h"

#include "vtkAlgorithm.h"
#include "vtkExecutive.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationObjectBaseKey.h"
#include "vtkInformationVector.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#ifdef TYNDALL_HAS_MPI
#include "vtkMPIController.h"
#endif

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <thread>

namespace tyndall
{
namespace
{
using Pipeline = vtkStreamingDemandDrivenPipeline;

constexpr int StopTag = 745202; ///< tag of the message by which a rank requests a stop

/// Key in a request: number of ranks that make the request together. The request carries this number upstream through
/// all filters.
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
  static auto* const key = new TogetherKey; // VTK deletes information keys when the process ends
  return key;
}

/// Key in a filter's information during its work: the controller of the ranks that work together.
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

/// Number of requested pieces, or number of ranks that make the request together, whichever is larger.
int Asking(vtkInformation* request, vtkInformationVector* outputs)
{
  vtkInformation* const asking = AskingPort(request, outputs);
  return asking ? std::max(PiecesAsked(request, outputs), asking->Get(Collective())) : 1;
}

/// Throws the same error on all ranks if the work of any rank failed. Collective.
/// @param own  outcome of the work on this rank
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
      Throw(own); // on this rank, the input failed or is empty, which is no error of this filter
    }
    throw;
  }
}

bool IsOne(vtkMultiProcessController* controller)
{
  return controller == nullptr || controller->GetNumberOfProcesses() == 1;
}

/// Messages by which a rank asks the other ranks to stop. All such messages are received before the ranks continue.
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

  /// Whether a message has arrived that asks this rank to stop.
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

  /// Asks all other ranks to stop.
  /// @return whether messages were sent; without MPI none are sent, because no rank could probe for them
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

  /// Receives the requests to stop that other ranks have sent.
  /// @param senders  for each rank: above 0 if the rank has sent messages
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
    // If voxels are around points or axes are permuted, the requested output extent may exceed the input's extent.
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

void OnFirstRank(vtkMultiProcessController* controller, const std::function<void()>& work)
{
  constexpr double endless = 1e8; // timeout, seconds: three years, in effect none
  const bool isOne = IsOne(controller);
  const auto stopped = [controller] { return StopMessages(controller).Waits(); };
  Ending ending = isOne || controller->GetLocalProcessId() == 0 ? EndingOf(work) : Ending();
  const std::unique_ptr<Communicator> communicator = CommunicatorOf(isOne ? nullptr : controller, stopped, endless);
  ending.kind = static_cast<Ending::Kind>(std::lround(communicator->Largest({ 1.0 * ending.kind })[0]));
  ending.why = WordsOfAny(*communicator, ending.why);
  Throw(ending);
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
  // Controller that an enclosing call of WorkOnAllRanks has set; it is restored after the work.
  vtkObjectBase* const before = filter->GetInformation()->Get(WorkingRanks());
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

double OfFirstRank(Communicator& ranks, double own)
{
  return ranks.Largest({ ranks.Rank() == 0 ? own : -std::numeric_limits<double>::infinity() })[0];
}

std::string OfFirstRank(Communicator& ranks, const std::string& own)
{
  return WordsOfAny(ranks, ranks.Rank() == 0 ? own : "");
}

bool IsStoppedByOthers(vtkAlgorithm* filter)
{
  auto* const controller = vtkMultiProcessController::SafeDownCast(filter->GetInformation()->Get(WorkingRanks()));
  return controller && StopMessages(controller).Waits();
}

namespace
{
#ifdef TYNDALL_HAS_MPI
constexpr int Nobody = -1;
constexpr int ArriveTag = 745203, AnswerTag = 745204; ///< tags of messages to the first rank, and from the first rank
/// Additional waiting time of the other ranks, seconds: the first rank times out before them, and decides whether a
/// rank is missing.
constexpr double Slack = 5.0;

bool IsPast(const std::chrono::steady_clock::time_point& start, double seconds)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > seconds;
}

void Rest()
{
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// Message that a rank sends on arrival at the barrier: the number of the barrier in the rank's own count, or 0 to
/// withdraw, and a hash of the filter's class name.
using Arrival = std::array<int, 2>;
/// Answer of the first rank to an arrival: the number of the barrier, then the members of MissingRank.
using Decision = std::array<int, 3>;

int NumberOf(const char* filter)
{
  unsigned int number = 2166136261u; // FNV-1a hash: equal in all processes
  for (; *filter; ++filter)
  {
    number = (number ^ static_cast<unsigned char>(*filter)) * 16777619u;
  }
  return static_cast<int>(number >> 1);
}

/// Receives arrivals until all ranks have arrived or the timeout `wait` (seconds) is over. Then receives all messages
/// sent so far, such as the withdrawal of a rank that was too late for the previous barrier.
void Collect(vtkMPIController* ranks, double wait, std::vector<Arrival>& arrived)
{
  const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  const auto missing = [&] {
    return std::any_of(arrived.begin(), arrived.end(), [](const Arrival& word) { return !word[0]; });
  };
  for (int waits = 1; waits || (missing() && !IsPast(start, wait));)
  {
    int from = 0;
    ranks->Iprobe(vtkMultiProcessController::ANY_SOURCE, ArriveTag, &waits, &from);
    if (waits)
    {
      ranks->Receive(arrived[static_cast<std::size_t>(from)].data(), 2, from, ArriveTag);
    }
    else
    {
      Rest();
    }
  }
}

/// Part of the barrier on the first rank: collects arrivals, and answers them.
MissingRank Decide(vtkMPIController* ranks, double wait, int filter)
{
  std::vector<Arrival> arrived(static_cast<std::size_t>(ranks->GetNumberOfProcesses()), Arrival{ 0, 0 });
  arrived[0] = { 1, filter };
  Collect(ranks, wait, arrived);
  const auto first = [&](auto test) {
    const auto found = std::find_if(arrived.begin(), arrived.end(), test);
    return found == arrived.end() ? Nobody : static_cast<int>(found - arrived.begin());
  };
  MissingRank missingRank{ first([](const Arrival& word) { return word[0] == 0; }), false };
  if (missingRank.rank == Nobody)
  {
    missingRank.rank = first([&](const Arrival& word) { return word[1] != filter; });
    missingRank.elsewhere = missingRank.rank != Nobody;
  }
  for (std::size_t rank = 1; rank < arrived.size(); ++rank)
  {
    if (arrived[rank][0] != 0)
    {
      const Decision decision = { arrived[rank][0], missingRank.rank, missingRank.elsewhere };
      ranks->Send(decision.data(), 3, static_cast<int>(rank), AnswerTag);
    }
  }
  return missingRank;
}

/// Part of the barrier on other ranks: announces this rank's arrival, and waits for the answer. A rank that times out
/// withdraws its arrival; an answer that has already been sent still counts.
MissingRank Arrive(vtkMPIController* ranks, double wait, int filter)
{
  static int barriers = 0;
  const Arrival own = { ++barriers, filter }, withdrawn = { 0, 0 };
  const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  ranks->Send(own.data(), 2, 0, ArriveTag);
  for (bool gone = false; !gone || !IsPast(start, wait + 2.0 * Slack);)
  {
    int waits = 0, from = 0;
    ranks->Iprobe(0, AnswerTag, &waits, &from);
    if (waits)
    {
      Decision decision = {};
      ranks->Receive(decision.data(), 3, 0, AnswerTag);
      if (decision[0] == own[0]) // another number belongs to a barrier at which this rank no longer waits
      {
        return { decision[1], decision[2] != 0 };
      }
      continue;
    }
    if (!gone && IsPast(start, wait + Slack))
    {
      ranks->Send(withdrawn.data(), 2, 0, ArriveTag);
      gone = true;
    }
    Rest();
  }
  return { 0, false };
}
#endif
}

MissingRank FindMissingRank(vtkMultiProcessController* ranks, const char* filter)
{
#ifdef TYNDALL_HAS_MPI
  if (auto* const mpi = vtkMPIController::SafeDownCast(ranks))
  {
    const int number = NumberOf(filter);
    return mpi->GetLocalProcessId() == 0 ? Decide(mpi, SecondsToWait(), number) : Arrive(mpi, SecondsToWait(), number);
  }
#endif
  (void)ranks;
  (void)filter;
  return {};
}
}
