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
  /// @param tag  one of MessageTags.h, or a number from 0 on, less than those
  template <class T>
  void Send(int to, int tag, const std::vector<T>& values)
  {
    this->CountAndSend(to, tag, BytesOf(values));
  }
  /// Waits for it.
  template <class T>
  std::vector<T> Receive(int from, int tag)
  {
    return ValuesOf<T>(from == this->Rank() ? this->TakeOwn(tag) : this->Take(from, tag));
  }

  /// To each of some ranks a parcel of values, and from each of them one; parcels may be empty. All ranks call it,
  /// those that have nobody to exchange with as well; a rank names all that name it.
  /// @param with  different ranks; this one may be among them
  /// @param pack  makes the parcels, one for each of `with`. Where it throws on one rank, it does on all (Collective),
  ///   and nothing is sent
  /// @return by the ranks of `with`, whatever comes first
  template <class T>
  std::vector<std::vector<T>> Exchange(
    const std::vector<int>& with, const std::function<std::vector<std::vector<T>>()>& pack)
  {
    std::vector<std::vector<char>> bytes;
    this->Collective([&] {
      std::vector<std::vector<T>> parcels = pack();
      for (std::vector<T>& parcel : parcels)
      {
        bytes.push_back(BytesOf(parcel));
        parcel = {};
      }
      this->RequireParcels(with, bytes);
    });
    bytes = this->CountAndExchange(with, std::move(bytes));
    std::vector<std::vector<T>> arrived;
    for (std::vector<char>& parcel : bytes)
    {
      arrived.push_back(ValuesOf<T>(parcel));
      parcel = {};
    }
    return arrived;
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
  void Collective(const std::function<void()>& work);

  const Traffic& Sent() const { return this->Counted; }

protected:
  virtual void Give(int to, int tag, std::vector<char> bytes) = 0;
  virtual std::vector<char> Take(int from, int tag) = 0;

  /// An exchange with others: all ranks call it at once, just after they agreed that nothing has gone wrong. Here it is
  /// done by messages.
  /// @param with  none of them this rank
  virtual std::vector<std::vector<char>> Swap(const std::vector<int>& with, std::vector<std::vector<char>> parcels);

private:
  template <class T>
  static std::vector<char> BytesOf(const std::vector<T>& values)
  {
    std::vector<char> bytes(values.size() * sizeof(T));
    if (!bytes.empty())
    {
      std::memcpy(bytes.data(), values.data(), bytes.size());
    }
    return bytes;
  }
  template <class T>
  static std::vector<T> ValuesOf(const std::vector<char>& bytes)
  {
    std::vector<T> values(bytes.size() / sizeof(T));
    if (!values.empty())
    {
      std::memcpy(values.data(), bytes.data(), values.size() * sizeof(T));
    }
    return values;
  }

  using Joined = std::function<double(double, double)>;
  std::vector<double> OverRanks(const std::vector<double>& values, const Joined& join);
  std::vector<char> Agree(const std::vector<char>& own);
  void CountAndSend(int to, int tag, std::vector<char> bytes);
  std::vector<char> TakeOwn(int tag);
  void RequireParcels(const std::vector<int>& with, const std::vector<std::vector<char>>& parcels) const;
  std::vector<std::vector<char>> CountAndExchange(const std::vector<int>& with, std::vector<std::vector<char>> parcels);

  Traffic Counted;
  std::map<int, std::deque<std::vector<char>>> ToItself; ///< by tag
};

/// The words of the first rank that has any, on each; empty: none has. All ranks call it.
std::string WordsOfAny(Communicator& communicator, const std::string& own);

/// Whether it is so on any rank. All ranks call it.
bool OnAnyRank(Communicator& communicator, bool own);

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
