#include "Ranks/ControllerCommunicator.h"

#include "Device/Errors.h"
#include "Distribution/MessageTags.h"

#ifdef TYNDALL_HAS_DIY
#include "Ranks/RankExchange.h"
#endif
#ifdef TYNDALL_HAS_MPI
#include "vtkMPIController.h"
#endif

#include <chrono>
#include <exception>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace tyndall
{
#ifdef TYNDALL_HAS_MPI
namespace
{
constexpr int FirstOfAll = 1000000; ///< tags, behind those of VTK and of the other messages of ranks
constexpr double Grace = 1.0;       ///< seconds in which what others have sent before they stopped still arrives

/// What is still being sent when an error ends a conversation: MPI may read it for as long as the process lives.
template <class Messages>
void LeaveBehind(Messages& messages)
{
  static Messages left;
  left.splice(left.end(), messages);
}

/// What an MPI call says that did not do what it should.
void RequireSent(bool done, const char* what, int rank)
{
  if (!done)
  {
    throw std::runtime_error(std::string(what) + " rank " + std::to_string(rank) + " failed: is it still there?");
  }
}
}

ControllerCommunicator::ControllerCommunicator(
  vtkMPIController* controller, double patience, std::function<bool()> stopped, int conversation)
  : Controller(controller)
  , Patience(patience)
  , Stopped(std::move(stopped))
  , FirstTag(FirstOfAll + MessageTag::Count * conversation)
{
}

ControllerCommunicator::~ControllerCommunicator()
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  double waited = 0.0;
  for (this->ForgetSent(); !this->Sending.empty(); this->ForgetSent())
  {
    waited = std::chrono::duration<double>(Clock::now() - start).count();
    if (std::uncaught_exceptions() > 0 || waited > this->Patience)
    {
      LeaveBehind(this->Sending);
      return;
    }
    std::this_thread::sleep_for(std::chrono::microseconds(50));
  }
}

int ControllerCommunicator::Rank() const
{
  return this->Controller->GetLocalProcessId();
}

int ControllerCommunicator::Ranks() const
{
  return this->Controller->GetNumberOfProcesses();
}

/// A send that waits for its receiver could wait for one that waits for this rank to receive: rays of different octants
/// go both ways between two blocks.
void ControllerCommunicator::Give(int to, int tag, std::vector<char> bytes)
{
  this->ForgetSent();
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
  {
    throw std::runtime_error("A message of " + std::to_string(bytes.size()) +
      " bytes is longer than MPI takes: spread the medium over more ranks.");
  }
  this->Sending.push_back({ std::move(bytes), {} });
  Underway& message = this->Sending.back();
  const int length = static_cast<int>(message.bytes.size());
  RequireSent(
    this->Controller->NoBlockSend(message.bytes.data(), length, to, this->FirstTag + tag, message.request) == 1,
    "Sending to", to);
}

void ControllerCommunicator::ForgetSent()
{
  for (auto message = this->Sending.begin(); message != this->Sending.end();)
  {
    message = message->request.Test() ? this->Sending.erase(message) : std::next(message);
  }
}

std::vector<char> ControllerCommunicator::Take(int from, int tag)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  double stoppedAt = -1.0;
  for (;;)
  {
    int isThere = 0, source = 0, length = 0;
    const char* type = nullptr;
    RequireSent(this->Controller->Iprobe(from, this->FirstTag + tag, &isThere, &source, type, &length) == 1,
      "Asking for a message of", from);
    if (isThere)
    {
      std::vector<char> bytes(static_cast<std::size_t>(length) + 1); // there is no array of nothing
      RequireSent(
        this->Controller->Receive(bytes.data(), length, from, this->FirstTag + tag) == 1, "Receiving from", from);
      bytes.resize(static_cast<std::size_t>(length));
      return bytes;
    }
    const std::chrono::duration<double> waited = Clock::now() - start;
    if (waited.count() > this->Patience)
    {
      throw std::runtime_error("Nothing came from rank " + std::to_string(from) + " within " +
        std::to_string(static_cast<int>(this->Patience)) + " s: it may be gone.");
    }
    if (stoppedAt < 0.0 && this->Stopped && this->Stopped())
    {
      stoppedAt = waited.count();
    }
    if (stoppedAt >= 0.0 && waited.count() > stoppedAt + Grace)
    {
      throw Aborted();
    }
    this->ForgetSent();
    std::this_thread::sleep_for(std::chrono::microseconds(waited.count() < 1e-3 ? 0 : 50));
  }
}

#ifdef TYNDALL_HAS_DIY
std::vector<std::vector<char>> ControllerCommunicator::Swap(
  const std::vector<int>& with, std::vector<std::vector<char>> parcels)
{
  if (this->Stopped && this->Stopped()) // one has left: the others would wait for it inside DIY
  {
    throw Aborted();
  }
  return ExchangeByDIY(this->Controller, with, std::move(parcels), this->Patience);
}
#endif
#endif

namespace
{
constexpr int Conversations = 64, Works = 16; ///< until tags come again; those of frames are behind those of work
int Work = 0, Conversation = 0, Frame = 0;

std::unique_ptr<Communicator> Make(
  vtkMultiProcessController* ranks, [[maybe_unused]] std::function<bool()> stopped, [[maybe_unused]] int conversation)
{
  if (!ranks)
  {
    return std::make_unique<SingleRank>();
  }
#ifdef TYNDALL_HAS_MPI
  if (auto* const mpi = vtkMPIController::SafeDownCast(ranks))
  {
    return std::make_unique<ControllerCommunicator>(mpi, SecondsToWait(), std::move(stopped), conversation);
  }
#endif
  throw InvalidInput("Ranks that work together have to speak to each other by MPI, and VTK's controller does not.");
}
}

void BeginConversations()
{
  Work = (Work + 1) % Works;
  Conversation = 0;
}

std::unique_ptr<Communicator> CommunicatorOf(vtkMultiProcessController* ranks, std::function<bool()> stopped)
{
  Conversation = Conversation % (Conversations - 1) + 1;
  return Make(ranks, std::move(stopped), Work * Conversations + Conversation);
}

std::unique_ptr<Communicator> CommunicatorOfFrame(vtkMultiProcessController* ranks)
{
  Frame = (Frame + 1) % Conversations;
  return Make(ranks, {}, Works * Conversations + Frame);
}

std::unique_ptr<Communicator> CommunicatorAtEnd(vtkMultiProcessController* ranks)
{
  return Make(ranks, {}, Work * Conversations);
}
}
