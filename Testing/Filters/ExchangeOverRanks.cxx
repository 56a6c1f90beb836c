// What ranks exchange by MPI (and DIY, where the host has it): each parcel arrives where it is meant for, whole,
// whatever its length. Run by mpiexec; a program by itself. With the word `alone` the last rank stays away from an
// exchange, and the others must not wait for it.

#include "OverRanks.h"

#include "Pieces/ControllerCommunicator.h"

#include <chrono>
#include <string>
#include <thread>
#include <vector>

using namespace tyndall;

namespace
{
using test::Expect;

/// Of a round, from one rank to another: nothing, a few numbers, or more than MPI sends before somebody receives.
std::vector<int> ParcelOf(int round, int from, int to)
{
  const std::size_t lengths[] = { 0, 1, 7, 100000, 3 };
  std::vector<int> parcel(lengths[(round + 2 * from + 3 * to) % 5]);
  for (std::size_t i = 0; i < parcel.size(); ++i)
  {
    parcel[i] = static_cast<int>(i) + 1000 * from + 100 * to + 10 * round;
  }
  return parcel;
}

/// Whom a rank exchanges parcels with: all and itself, by descending numbers; the next in a row; or, but for the first
/// two, nobody.
std::vector<int> PartnersOf(int round, int rank, int ranks)
{
  std::vector<int> partners;
  for (int other = ranks - 1; other >= 0; --other)
  {
    const bool near = std::abs(other - rank) == 1, both = std::max(other, rank) < 2;
    if (round % 3 == 0 || (round % 3 == 1 && near) || (round % 3 == 2 && both))
    {
      partners.push_back(other);
    }
  }
  return partners;
}

bool ParcelsArrive(Communicator& communicator)
{
  const int self = communicator.Rank();
  bool right = true;
  for (int round = 0; round < 30; ++round)
  {
    const std::vector<int> with = PartnersOf(round, self, communicator.Ranks());
    const std::size_t before = communicator.Sent().bytes;
    std::size_t bytes = 0;
    const std::vector<std::vector<int>> arrived = communicator.Exchange<int>(with, [&] {
      std::vector<std::vector<int>> parcels;
      for (const int to : with)
      {
        parcels.push_back(ParcelOf(round, self, to));
        bytes += to == self ? 0 : parcels.back().size() * sizeof(int);
      }
      return parcels;
    });
    const std::string ofRound = " of round " + std::to_string(round);
    right = Expect(arrived.size() == with.size(), "not as many parcels" + ofRound, self) && right;
    for (std::size_t i = 0; i < arrived.size(); ++i)
    {
      const std::string which = "another parcel of rank " + std::to_string(with[i]) + ofRound;
      right = Expect(arrived[i] == ParcelOf(round, with[i], self), which, self) && right;
    }
    const std::size_t counted = communicator.Sent().bytes - before; // a few bytes more: ranks agree
    right = Expect(counted >= bytes && counted < bytes + 100, "bytes are not counted" + ofRound, self) && right;
  }
  return right;
}

/// What goes wrong on one rank as it packs goes wrong on all, and the next exchange is as good as any.
bool FailuresAreOfAll(Communicator& communicator)
{
  const int self = communicator.Rank(), last = communicator.Ranks() - 1;
  const std::vector<int> with = PartnersOf(0, self, communicator.Ranks());
  bool thrown = false;
  try
  {
    communicator.Exchange<int>(with, [&] {
      Require(self != last, "no parcels");
      return std::vector<std::vector<int>>(with.size(), { 1 });
    });
  }
  catch (const InvalidInput& error)
  {
    const std::string where = last > 0 ? "On rank " + std::to_string(last) + ": " : "";
    thrown = error.what() == where + "no parcels";
  }
  return Expect(thrown, "goes on although a rank has failed", self) && ParcelsArrive(communicator);
}

#ifdef TYNDALL_HAS_DIY
/// Ends all ranks, with words, long before the last one comes.
void WaitForOneThatIsGone(vtkMPIController* controller)
{
  const int self = controller->GetLocalProcessId(), last = controller->GetNumberOfProcesses() - 1;
  if (self == last)
  {
    std::this_thread::sleep_for(std::chrono::minutes(2));
    return;
  }
  ExchangeByDIY(controller, { last }, { { 'a' } }, 1.0);
}
#endif
}

int main(int argc, char* argv[])
{
  return test::RunOverRanks(argc, argv, [&](vtkMPIController* controller) {
#ifdef TYNDALL_HAS_DIY
    if (argc > 1 && std::string(argv[1]) == "alone")
    {
      WaitForOneThatIsGone(controller);
    }
#endif
    ControllerCommunicator first(controller, 60.0), second(controller, 60.0, {}, 1);
    return ParcelsArrive(first) && FailuresAreOfAll(second) && ParcelsArrive(first);
  });
}
