#pragma once

#include <cstddef>
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace tyndall
{
/// What ranks that share one computation say to each other. Each rank has one of its own and calls it from one thread.
/// Messages from one rank to another with the same tag arrive in the order they were sent in.
class Communicator
{
public:
  /// Sent by this rank, sums and agreements among them.
  struct Traffic
  {
    std::size_t messages = 0;
    std::size_t bytes = 0;
  };

  virtual ~Communicator() = default;
  virtual int Rank() const = 0;
  virtual int Ranks() const = 0;

  /// Does not wait for the other rank. A rank may send to itself: light comes round a periodic axis.
  /// @param tag  0 to 29999
  template <class T>
  void Send(int to, int tag, const std::vector<T>& values)
  {
    std::vector<char> bytes(values.size() * sizeof(T));
    if (!bytes.empty())
    {
      std::memcpy(bytes.data(), values.data(), bytes.size());
    }
    this->CountAndSend(to, tag, std::move(bytes));
  }
  /// Waits for it.
  template <class T>
  std::vector<T> Receive(int from, int tag)
  {
    const std::vector<char> bytes = from == this->Rank() ? this->TakeOwn(tag) : this->Take(from, tag);
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!bytes.empty())
    {
      std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    }
    return values;
  }

  /// Added up over the ranks in their order, and the largest of all ranks: the same on each, value by value. All ranks
  /// call it.
  /// @throws InvalidInput  on all ranks, where one has more values than another
  std::vector<double> Sum(const std::vector<double>& values);
  std::vector<double> Largest(const std::vector<double>& values);

  /// Runs `work` on every rank. Where it throws on one, it does on all, with the same words: those of the first rank
  /// where the worst went wrong (an abort is no error), with its number where it is not the same on all. All ranks call
  /// it; what they send each other in `work` they must send although something has gone wrong (SweepInBlocks.cxx does).
  /// @throws Aborted where a rank was, InvalidInput, DeviceError and others likewise
  void Together(const std::function<void()>& work);

  const Traffic& Sent() const { return this->Counted; }

protected:
  virtual void Give(int to, int tag, std::vector<char> bytes) = 0;
  virtual std::vector<char> Take(int from, int tag) = 0;

private:
  using Joined = std::function<double(double, double)>;
  std::vector<double> OverRanks(const std::vector<double>& values, const Joined& join);
  std::vector<char> Agree(const std::vector<char>& own);
  void CountAndSend(int to, int tag, std::vector<char> bytes);
  std::vector<char> TakeOwn(int tag);

  Traffic Counted;
  std::map<int, std::deque<std::vector<char>>> ToItself; ///< by tag
};

/// The words of the first rank that has any, on each; empty: none has. All ranks call it.
std::string WordsOfAny(Communicator& communicator, const std::string& own);

/// A computation's only rank.
class SingleRank : public Communicator
{
public:
  int Rank() const override { return 0; }
  int Ranks() const override { return 1; }

protected:
  void Give(int to, int tag, std::vector<char> bytes) override;
  std::vector<char> Take(int from, int tag) override;
};
}
