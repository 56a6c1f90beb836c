#include "RanksInThreads.h"

#include "Numerics/NumberText.h"

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <map>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace tyndall
{
namespace
{
/// Queue of messages that have been sent to one rank and not yet received.
class Mailbox
{
public:
  void Put(int from, int tag, std::vector<char> bytes)
  {
    const std::lock_guard<std::mutex> lock(this->Guard);
    this->Messages[{ from, tag }].push_back(std::move(bytes));
    this->Arrived.notify_all();
  }

  std::vector<char> Take(int from, int tag, double patience)
  {
    std::unique_lock<std::mutex> lock(this->Guard);
    std::deque<std::vector<char>>& queue = this->Messages[{ from, tag }];
    if (!this->Arrived.wait_for(lock, std::chrono::duration<double>(patience), [&] { return !queue.empty(); }))
    {
      throw std::runtime_error("nothing came from rank " + std::to_string(from) + " within " + Text("%g", patience) +
        " s (tag " + std::to_string(tag) + ")");
    }
    std::vector<char> bytes = std::move(queue.front());
    queue.pop_front();
    return bytes;
  }

private:
  std::mutex Guard;
  std::condition_variable Arrived;
  std::map<std::pair<int, int>, std::deque<std::vector<char>>> Messages; ///< messages by sender and tag
};

class RankInThread : public Communicator
{
public:
  RankInThread(int rank, std::vector<Mailbox>& mailboxes, double patience)
    : OwnRank(rank)
    , Mailboxes(mailboxes)
    , Patience(patience)
  {
  }
  int Rank() const override { return this->OwnRank; }
  int Ranks() const override { return static_cast<int>(this->Mailboxes.size()); }

protected:
  void Give(int to, int tag, std::vector<char> bytes) override
  {
    this->Mailboxes.at(to).Put(this->OwnRank, tag, std::move(bytes));
  }
  std::vector<char> Take(int from, int tag) override
  {
    return this->Mailboxes[this->OwnRank].Take(from, tag, this->Patience);
  }

private:
  int OwnRank;
  std::vector<Mailbox>& Mailboxes;
  double Patience;
};
}

void RunInThreads(int ranks, const std::function<void(Communicator&)>& work, double patience)
{
  std::vector<Mailbox> mailboxes(ranks);
  std::vector<std::exception_ptr> errors(ranks);
  std::vector<std::thread> threads;
  for (int rank = 0; rank < ranks; ++rank)
  {
    threads.emplace_back([&, rank] {
      RankInThread communicator(rank, mailboxes, patience);
      try
      {
        work(communicator);
      }
      catch (...)
      {
        errors[rank] = std::current_exception();
      }
    });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  for (const std::exception_ptr& error : errors)
  {
    if (error)
    {
      std::rethrow_exception(error);
    }
  }
}
}
