#include "Distribution/Communicator.h"

#include "Device/Errors.h"

#include <algorithm>
#include <iterator>
#include <new>
#include <utility>

namespace tyndall
{
namespace
{
/// Classes of failure that ranks report to each other, in order of increasing severity.
enum class Trouble : char
{
  None,
  OfOthers, ///< the rank misses a message (MissingMessage), because another rank has failed
  Stopped,  ///< the rank's work was aborted (Aborted)
  OfInput,  ///< the input is invalid (InvalidInput)
  OfDevice,
  OfMemory,
  Other
};

/// Outcome of a rank's work: the class and the text of its failure, or none.
struct Outcome
{
  Trouble trouble = Trouble::None;
  std::string words;
  std::exception_ptr error;
};

Outcome Try(const std::function<void()>& work)
{
  Outcome outcome;
  try
  {
    work();
  }
  catch (const MissingMessage& error)
  {
    outcome = { Trouble::OfOthers, error.what(), std::current_exception() };
  }
  catch (const Aborted& error)
  {
    outcome = { Trouble::Stopped, error.what(), std::current_exception() };
  }
  catch (const InvalidInput& error)
  {
    outcome = { Trouble::OfInput, error.what(), std::current_exception() };
  }
  catch (const DeviceError& error)
  {
    outcome = { Trouble::OfDevice, error.what(), std::current_exception() };
  }
  catch (const std::bad_alloc& error)
  {
    outcome = { Trouble::OfMemory, error.what(), std::current_exception() };
  }
  catch (const std::exception& error)
  {
    outcome = { Trouble::Other, error.what(), std::current_exception() };
  }
  return outcome;
}

void RequireAsMany(std::size_t found, std::size_t expected)
{
  Require(found == expected,
    "Ranks do not have as many values to add up as each other: something that they were given "
    "differs. Give all ranks the same properties.");
}

[[noreturn]] void Throw(Trouble trouble, const std::string& words)
{
  switch (trouble)
  {
    case Trouble::Stopped: throw Aborted();
    case Trouble::OfInput: throw InvalidInput(words);
    case Trouble::OfDevice: throw DeviceError(words);
    case Trouble::OfMemory: throw std::bad_alloc();
    default: throw std::runtime_error(words);
  }
}
}

void Communicator::CountAndSend(int to, int tag, std::vector<char> bytes)
{
  if (to == this->Rank())
  {
    this->ToItself[tag].push_back(std::move(bytes));
    return;
  }
  ++this->Counted.messages;
  this->Counted.bytes += bytes.size();
  this->Give(to, tag, std::move(bytes));
}

/// Removes and returns the oldest of the messages with a tag that this rank has sent to itself.
std::vector<char> Communicator::TakeOwn(int tag)
{
  std::deque<std::vector<char>>& sent = this->ToItself[tag];
  if (sent.empty())
  {
    throw std::logic_error("a rank waits for what it has not sent to itself");
  }
  std::vector<char> bytes = std::move(sent.front());
  sent.pop_front();
  return bytes;
}

/// Combines the values of all ranks in rank order. Rank 0 combines them, and sends the result to all ranks.
/// @throws InvalidInput on all ranks, if the numbers of values differ: the ranks are then at different points of a
///   computation, or have different settings
std::vector<double> Communicator::OverRanks(const std::vector<double>& values, const Joined& join)
{
  if (this->Rank() > 0)
  {
    this->Send(0, MessageTag::Sums, values);
    const std::vector<double> all = this->Receive<double>(0, MessageTag::Sums);
    RequireAsMany(all.size(), values.size());
    return all;
  }
  std::vector<double> all = values;
  std::size_t most = all.size(), least = all.size();
  for (int rank = 1; rank < this->Ranks(); ++rank)
  {
    const std::vector<double> ofRank = this->Receive<double>(rank, MessageTag::Sums);
    most = std::max(most, ofRank.size());
    least = std::min(least, ofRank.size());
    std::transform(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(std::min(all.size(), ofRank.size())),
      ofRank.begin(), all.begin(), join);
  }
  if (least < most)
  {
    all.assign(most + 1, 0.0); // one value more than any rank expects, so that all ranks throw
  }
  for (int rank = 1; rank < this->Ranks(); ++rank)
  {
    this->Send(rank, MessageTag::Sums, all);
  }
  RequireAsMany(all.size(), values.size());
  return all;
}

std::vector<double> Communicator::Sum(const std::vector<double>& values)
{
  return this->OverRanks(values, std::plus<double>());
}

std::vector<double> Communicator::Largest(const std::vector<double>& values)
{
  return this->OverRanks(values, [](double a, double b) { return std::max(a, b); });
}

std::vector<char> Communicator::Agree(const std::vector<char>& own)
{
  if (this->Rank() > 0)
  {
    this->Send(0, MessageTag::Agreements, own);
    return this->Receive<char>(0, MessageTag::Agreements);
  }
  std::vector<char> worst = own;
  int from = 0;
  bool alike = true;
  for (int rank = 1; rank < this->Ranks(); ++rank)
  {
    const std::vector<char> ofRank = this->Receive<char>(rank, MessageTag::Agreements);
    alike = alike && ofRank == own;
    if (ofRank[0] > worst[0])
    {
      worst = ofRank;
      from = rank;
    }
  }
  const std::string words(worst.begin() + 1, worst.end());
  // A text that begins with "On rank " already names the rank, because it comes from a nested call of Collective.
  if (!alike && words.rfind("On rank ", 0) != 0)
  {
    const std::string where = "On rank " + std::to_string(from) + ": ";
    worst.insert(worst.begin() + 1, where.begin(), where.end());
  }
  for (int rank = 1; rank < this->Ranks(); ++rank)
  {
    this->Send(rank, MessageTag::Agreements, worst);
  }
  return worst;
}

void Communicator::Collective(const std::function<void()>& work)
{
  const Outcome own = Try(work);
  if (this->Ranks() == 1)
  {
    if (own.error)
    {
      std::rethrow_exception(own.error);
    }
    return;
  }
  std::vector<char> said = { static_cast<char>(own.trouble) };
  said.insert(said.end(), own.words.begin(), own.words.end());
  said = this->Agree(said);
  if (said[0] != static_cast<char>(Trouble::None))
  {
    Throw(static_cast<Trouble>(said[0]), std::string(said.begin() + 1, said.end()));
  }
}

void Communicator::RequireParcels(const std::vector<int>& with, const std::vector<std::vector<char>>& parcels) const
{
  std::vector<int> ranks = with;
  std::sort(ranks.begin(), ranks.end());
  const bool different = std::adjacent_find(ranks.begin(), ranks.end()) == ranks.end();
  if (parcels.size() != ranks.size() || !different ||
    (!ranks.empty() && (ranks.front() < 0 || ranks.back() >= this->Ranks())))
  {
    throw std::logic_error("an exchange takes a parcel for each of several different ranks");
  }
}

/// Exchanges parcels by Swap, and counts messages and bytes. A parcel holds the bytes that this rank sends to one other
/// rank. A rank's parcel for itself is neither sent nor counted.
std::vector<std::vector<char>> Communicator::CountAndExchange(
  const std::vector<int>& with, std::vector<std::vector<char>> parcels)
{
  const std::size_t own = static_cast<std::size_t>(std::find(with.begin(), with.end(), this->Rank()) - with.begin());
  std::vector<char> kept;
  std::vector<int> others = with;
  if (own < with.size())
  {
    kept = std::move(parcels[own]);
    parcels.erase(parcels.begin() + static_cast<std::ptrdiff_t>(own));
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(own));
  }
  this->Counted.messages += others.size();
  for (const std::vector<char>& parcel : parcels)
  {
    this->Counted.bytes += parcel.size();
  }
  parcels = this->Swap(others, std::move(parcels));
  if (own < with.size())
  {
    parcels.insert(parcels.begin() + static_cast<std::ptrdiff_t>(own), std::move(kept));
  }
  return parcels;
}

std::vector<std::vector<char>> Communicator::Swap(const std::vector<int>& with, std::vector<std::vector<char>> parcels)
{
  for (std::size_t i = 0; i < with.size(); ++i)
  {
    this->Give(with[i], MessageTag::Parcels, std::move(parcels[i]));
  }
  for (std::size_t i = 0; i < with.size(); ++i)
  {
    parcels[i] = this->Take(with[i], MessageTag::Parcels);
  }
  return parcels;
}

void SingleRank::Give(int, int, std::vector<char>)
{
  throw std::logic_error("a single rank has nobody to send to");
}

std::vector<char> SingleRank::Take(int, int)
{
  throw std::logic_error("a single rank has nobody to hear from");
}

bool OnAnyRank(Communicator& communicator, bool own)
{
  return communicator.Largest({ own ? 1.0 : 0.0 })[0] > 0.0;
}

std::string WordsOfAny(Communicator& communicator, const std::string& own)
{
  const double none = communicator.Ranks();
  const double first = -communicator.Largest({ -(own.empty() ? none : communicator.Rank()) })[0];
  const bool says = communicator.Rank() == first;
  std::vector<double> letters(
    static_cast<std::size_t>(communicator.Largest({ says ? 1.0 * static_cast<double>(own.size()) : 0.0 })[0]), 0.0);
  if (says)
  {
    std::copy(own.begin(), own.end(), letters.begin());
  }
  letters = communicator.Sum(letters);
  std::string words;
  std::transform(
    letters.begin(), letters.end(), std::back_inserter(words), [](double letter) { return static_cast<char>(letter); });
  return words;
}
}
