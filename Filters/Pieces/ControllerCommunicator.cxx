#include "Pieces/ControllerCommunicator.h"

#include "Device/Errors.h"
#include "Numerics/NumberText.h"

#ifdef TYNDALL_HAS_DIY
#include "vtkDIYUtilities.h"
#endif
#ifdef TYNDALL_HAS_MPI
#include "vtkMPIController.h"
#endif

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <limits>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace tyndall
{
double SecondsToWait()
{
  // Default and longest timeout for waiting on another rank, seconds. The longest, three years, is still within the
  // range of the clock.
  constexpr double usual = 600.0, longest = 1e8;
  const char* const said = std::getenv("TYNDALL_RANKS_WAIT");
  const double seconds = NumberIn(said ? said : "").value_or(0.0);
  return seconds > 0.0 ? std::min(seconds, longest) : usual;
}

#ifdef TYNDALL_HAS_MPI
namespace
{
constexpr int FirstOfAll = 1000000; ///< first message tag of communicators, above the tags of VTK and of Ranks.cxx
constexpr double Grace = 1.0;       ///< time after a request to stop for which messages are still received, seconds

/// Never frees messages whose sends are incomplete when an error occurs: MPI may read their memory until the process
/// ends.
template <class Messages>
void LeaveBehind(Messages& messages)
{
  static Messages left;
  left.splice(left.end(), messages);
}

/// Throws an error unless an MPI call to another rank succeeded.
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

/// Sends a message without blocking: rays of different octants travel in both directions between two subdomains, so
/// blocking sends could deadlock.
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
      std::vector<char> bytes(static_cast<std::size_t>(length) + 1); // avoids a null pointer for empty messages
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
  if (this->Stopped && this->Stopped()) // another rank has requested a stop; DIY would wait for it without limit
  {
    throw Aborted();
  }
  return ExchangeByDIY(this->Controller, with, std::move(parcels), this->Patience);
}
#endif
#endif

namespace
{
/// Message tags are reused after Conversations communicators in one call of WorkOnAllRanks, and after Works calls. The
/// tags of CommunicatorOfFrame follow those of WorkOnAllRanks.
constexpr int Conversations = 64, Works = 16;
int Work = 0, Conversation = 0, Frame = 0;

std::unique_ptr<Communicator> Make(vtkMultiProcessController* ranks, [[maybe_unused]] std::function<bool()> stopped,
  [[maybe_unused]] int conversation, [[maybe_unused]] double patience = SecondsToWait())
{
  if (!ranks)
  {
    return std::make_unique<SingleRank>();
  }
#ifdef TYNDALL_HAS_MPI
  if (auto* const mpi = vtkMPIController::SafeDownCast(ranks))
  {
    return std::make_unique<ControllerCommunicator>(mpi, patience, std::move(stopped), conversation);
  }
#endif
  throw InvalidInput("Ranks work together by MPI only, and VTK's controller is of another kind, or this build of "
                     "Tyndall has no MPI (TYNDALL_WITH_MPI). Use one rank, or a build with MPI.");
}
}

void BeginConversations()
{
  Work = (Work + 1) % Works;
  Conversation = 0;
}

std::unique_ptr<Communicator> CommunicatorOf(
  vtkMultiProcessController* ranks, std::function<bool()> stopped, double patience)
{
  Conversation = Conversation % (Conversations - 1) + 1;
  return Make(ranks, std::move(stopped), Work * Conversations + Conversation, patience);
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

#ifdef TYNDALL_HAS_DIY
namespace
{
/// Ends this process after an error that cannot be reported to other ranks; MPI then ends all ranks.
[[noreturn]] void EndAllRanks(int rank, const std::string& why)
{
  std::cerr << "Tyndall, rank " << rank << ": " << why << " All ranks are ended." << std::endl;
  std::_Exit(EXIT_FAILURE);
}

/// Timer that ends all ranks unless it is destroyed before the timeout.
class Deadline
{
public:
  Deadline(int rank, double seconds)
    : Watch([this, rank, seconds] {
      std::unique_lock<std::mutex> lock(this->Guard);
      if (!this->Changed.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return this->Kept; }))
      {
        EndAllRanks(rank,
          "an exchange has not ended within " + std::to_string(static_cast<int>(seconds)) + " s: a rank may be gone.");
      }
    })
  {
  }
  ~Deadline()
  {
    {
      const std::lock_guard<std::mutex> lock(this->Guard);
      this->Kept = true;
    }
    this->Changed.notify_one();
    this->Watch.join();
  }
  Deadline(const Deadline&) = delete;
  Deadline& operator=(const Deadline&) = delete;

private:
  std::mutex Guard;
  std::condition_variable Changed;
  bool Kept = false;
  std::thread Watch; // last member: the thread uses the other members
};

/// Parcels (one array of bytes for each rank of the exchange) in a rank's DIY block: before the exchange the parcels to
/// send, afterwards the received parcels.
struct Parcels
{
  std::vector<std::vector<char>> ofRanks;
};

/// DIY's master for the ranks of a controller, with one block per rank. Collective at the first exchange, when the
/// master is made, with its own MPI communicator because DIY's tags are small numbers. The master is stored as an
/// attribute of the controller's communicator and never deleted, since MPI may be finalised first.
diy::Master& MasterOf(vtkMPIController* controller)
{
  static int key = MPI_KEYVAL_INVALID;
  if (key == MPI_KEYVAL_INVALID)
  {
    MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, MPI_COMM_NULL_DELETE_FN, &key, nullptr);
  }
  diy::mpi::communicator ranks = vtkDIYUtilities::GetCommunicator(controller);
  void* kept = nullptr;
  int isThere = 0;
  MPI_Comm_get_attr(ranks, key, &kept, &isThere);
  if (!isThere)
  {
    auto* const master = new diy::Master(ranks);
    master->add(ranks.rank(), new Parcels, new diy::Link);
    MPI_Comm_set_attr(ranks, key, master);
    return *master;
  }
  return *static_cast<diy::Master*>(kept);
}

/// Exchanges one parcel (array of bytes) with each rank of `with`; parcels become DIY's queues without a copy.
/// Collective.
std::vector<std::vector<char>> Exchange(
  diy::Master& master, const std::vector<int>& with, std::vector<std::vector<char>> parcels)
{
  auto* const link = new diy::Link; // the master takes ownership and deletes it
  for (const int rank : with)
  {
    link->add_neighbor({ rank, rank });
  }
  master.replace_link(0, link);
  master.block<Parcels>(0)->ofRanks = std::move(parcels);
  master.foreach ([](Parcels* block, const diy::Master::ProxyWithLink& others) {
    for (int i = 0; i < others.link()->size(); ++i)
    {
      diy::MemoryBuffer& queue = others.outgoing(others.link()->target(i));
      queue.buffer = std::move(block->ofRanks[static_cast<std::size_t>(i)]);
      queue.position = queue.buffer.size();
    }
  });
  master.exchange();
  master.foreach ([](Parcels* block, const diy::Master::ProxyWithLink& others) {
    for (int i = 0; i < others.link()->size(); ++i)
    {
      block->ofRanks[static_cast<std::size_t>(i)] = std::move(others.incoming(others.link()->target(i).gid).buffer);
    }
  });
  return std::move(master.block<Parcels>(0)->ofRanks);
}
}

std::vector<std::vector<char>> ExchangeByDIY(
  vtkMPIController* controller, const std::vector<int>& with, std::vector<std::vector<char>> parcels, double patience)
{
  const int rank = controller->GetLocalProcessId();
  try
  {
    const Deadline deadline(rank, patience);
    return Exchange(MasterOf(controller), with, std::move(parcels));
  }
  catch (const std::exception& error) // ends all ranks, which would wait for this one without limit
  {
    EndAllRanks(rank, std::string("an exchange has failed: ") + error.what() + ".");
  }
}
#endif
}
