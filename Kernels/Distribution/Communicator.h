#pragma once

#include <cstddef>
#include <cstring>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace tyndall
{
/// Tags of messages between ranks, one for each purpose. Sweeps and lattice steps number their messages from 0 on;
/// these numbers stay below the tags.
namespace MessageTag
{
constexpr int ColumnsOfSight = 29992; ///< for columns of voxels seen by parallel rays, LitColor.cxx
constexpr int CornersOfPaths = 29995; ///< for vertices of photon paths, PhotonPaths.cxx
constexpr int RunsOfBytes = 29996;    ///< for run-length encoded bytes, BrickedBytes.cxx
constexpr int GhostCells = 29998;     ///< for values of ghost cells, Halo.cxx
constexpr int ValuesOfBoxes = 29999;  ///< for values in boxes, BoxExchange.cxx
constexpr int Sums = 30000;           ///< for reductions, Communicator.cxx
constexpr int Agreements = 30001;     ///< for agreements about errors, Communicator.cxx
constexpr int Parcels = 30002;        ///< for the parcels of Exchange, Communicator.cxx
constexpr int Count = 30010;          ///< all tags are below this number
}

/// Message passing among the ranks of one solve. Each rank owns one Communicator and calls it from one thread. Messages
/// from one rank to another with the same tag arrive in the order in which they were sent.
class Communicator
{
public:
  /// Messages and bytes that this rank has sent, including those of reductions and error agreements.
  struct Traffic
  {
    std::size_t messages = 0;
    std::size_t bytes = 0;
  };

  virtual ~Communicator() = default;
  virtual int Rank() const = 0;
  virtual int Ranks() const = 0;

  /// Sends values without waiting for the receiver. A rank may send to itself, because light wraps around periodic
  /// axes.
  /// @param tag  one of MessageTag, or a non-negative number smaller than those
  template <class T>
  void Send(int to, int tag, const std::vector<T>& values)
  {
    this->CountAndSend(to, tag, BytesOf(values));
  }
  /// Waits for a message and returns its values.
  template <class T>
  std::vector<T> Receive(int from, int tag)
  {
    return ValuesOf<T>(from == this->Rank() ? this->TakeOwn(tag) : this->Take(from, tag));
  }

  /// Sends one parcel of values to each rank of `with`, and receives one from each; parcels may be empty. Collective:
  /// ranks without partners call it too, and if rank a names rank b, then b must name a.
  /// @param with  different ranks; this rank may be among them
  /// @param pack  creates the parcels, one per rank of `with`. If it throws on one rank, all ranks throw (Collective)
  ///   and nothing is sent
  /// @return the received parcels, in the order of `with` whatever the order of arrival
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

  /// Sum, and maximum, of each element of `values` over the ranks, identical on every rank. Sums are added in rank
  /// order. Collective.
  /// @throws InvalidInput on all ranks, if the numbers of values differ
  std::vector<double> Sum(const std::vector<double>& values);
  std::vector<double> Largest(const std::vector<double>& values);

  /// Runs `work` on every rank. If any rank throws, all ranks throw the most severe of the errors; aborts are less
  /// severe than errors. Among equally severe errors, that of the lowest rank is thrown. The text names this rank
  /// unless all ranks failed alike. Collective. Messages that ranks exchange within `work` must be sent even after an
  /// error (as SweepInBlocks.cxx does).
  /// @throws Aborted, InvalidInput, DeviceError or another error, as the failed rank threw it
  void Collective(const std::function<void()>& work);

  const Traffic& Sent() const { return this->Counted; }

protected:
  virtual void Give(int to, int tag, std::vector<char> bytes) = 0;
  virtual std::vector<char> Take(int from, int tag) = 0;

  /// Exchanges parcels with other ranks; a parcel holds the bytes for one other rank. This default implementation sends
  /// messages. Collective; called directly after all ranks have agreed that none has failed.
  /// @param with  ranks to exchange with, this rank not among them; parcels are in the same order
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
  std::map<int, std::deque<std::vector<char>>> ToItself; ///< messages from this rank to itself, by tag
};

/// The text `own` of the lowest rank on which it is not empty; empty if there is no such rank. The result is the same
/// on every rank. Collective.
std::string WordsOfAny(Communicator& communicator, const std::string& own);

/// Whether `own` is true on at least one rank. The result is the same on every rank. Collective.
bool OnAnyRank(Communicator& communicator, bool own);

/// Communicator of a serial solve: a single rank.
class SingleRank : public Communicator
{
public:
  int Rank() const override { return 0; }
  int Ranks() const override { return 1; }

protected:
  void Give(int to, int tag, std::vector<char> bytes) override;
  std::vector<char> Take(int from, int tag) override;
};

/// Thrown if a message is shorter than the receiving rank expects, because its sender has failed.
/// Communicator::Collective reports the sender's error instead, if the sender threw one.
struct MissingMessage : std::runtime_error
{
  MissingMessage()
    : std::runtime_error("Ranks were not sent as much as they wait for, and none says why: something that they were "
                         "given differs. Give all ranks the same properties.")
  {
  }
};

/// Holds the first error of a rank while other ranks still wait for its messages. The rank continues with empty
/// messages, and throws the error at the end of the work.
struct HeldFailure
{
  /// Runs `work` and holds the error that it throws. Does nothing if an error is already held.
  void Attempt(const std::function<void()>& work)
  {
    try
    {
      if (!this->broken)
      {
        work();
      }
    }
    catch (...)
    {
      this->error = std::current_exception();
      this->broken = true;
    }
  }

  /// Throws the held error, or returns if there is none. Must be called at the end of the work, within
  /// Communicator::Collective.
  void Throw() const
  {
    if (this->error)
    {
      std::rethrow_exception(this->error);
    }
    if (this->broken)
    {
      throw MissingMessage();
    }
  }

  bool broken = false; ///< whether this rank has failed, or did not receive a message because another rank has failed
  std::exception_ptr error;
};
}
