#include "Ranks/RankExchange.h"

#include "vtkDIYUtilities.h"
#include "vtkMPIController.h"

#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <mutex>
#include <string>
#include <thread>

namespace tyndall
{
namespace
{
/// The last resort, of which MPI takes notice wherever this process is.
[[noreturn]] void EndAllRanks(int rank, const std::string& why)
{
  std::cerr << "Tyndall, rank " << rank << ": " << why << " All ranks are ended." << std::endl;
  std::_Exit(EXIT_FAILURE);
}

/// Ends all unless it is destroyed in time.
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
  std::thread Watch; // last: it uses the others
};

/// What a rank's block has for others, and then what they had for it.
struct Parcels
{
  std::vector<std::vector<char>> ofRanks;
};

/// DIY's master of the ranks of a controller, with a block on each. It is made by all of them when they first exchange
/// something, with a communicator of its own: DIY's tags are small numbers, as others' may be. MPI keeps it beside the
/// controller's communicator; it is never deleted, for MPI may have ended before.
diy::Master& MasterOf(vtkMPIController* controller)
{
  static int key = MPI_KEYVAL_INVALID;
  if (key == MPI_KEYVAL_INVALID)
  {
    MPI_Comm_create_keyval(MPI_COMM_NULL_COPY_FN, MPI_COMM_NULL_DELETE_FN, &key, nullptr);
  }
  const diy::mpi::communicator ranks = vtkDIYUtilities::GetCommunicator(controller);
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

/// Parcels are DIY's queues as they are, for what is put into these is copied.
std::vector<std::vector<char>> Exchange(
  diy::Master& master, const std::vector<int>& with, std::vector<std::vector<char>> parcels)
{
  auto* const link = new diy::Link; // the master's
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
  catch (const std::exception& error) // others wait for this rank, without an end
  {
    EndAllRanks(rank, std::string("an exchange has failed: ") + error.what() + ".");
  }
}
}
