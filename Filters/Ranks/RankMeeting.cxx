#include "Ranks/RankMeeting.h"

#include "Numerics/NumberText.h"

#ifdef TYNDALL_HAS_MPI
#include "vtkMPIController.h"
#endif

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
#include <thread>
#include <vector>

namespace tyndall
{
namespace
{
constexpr double UsualWait = 600.0, LongestWait = 1e8; ///< seconds; clocks count no longer than centuries

#ifdef TYNDALL_HAS_MPI
constexpr int Nobody = -1;
constexpr int ComeTag = 745203, GoTag = 745204; ///< of messages to the first rank, and from it
constexpr double Slack = 5.0;                   ///< seconds that others wait longer than the first rank, which decides

bool IsPast(const std::chrono::steady_clock::time_point& start, double seconds)
{
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > seconds;
}

void Rest()
{
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// What a rank says that comes: the number of the meeting as it counts them itself, 0 where it withdraws, and a number
/// for the class of its filter.
using Word = std::array<int, 2>;
/// What the first rank answers: that number, and who is absent.
using Decision = std::array<int, 3>;

int NumberOf(const char* filter)
{
  unsigned int number = 2166136261u; // FNV-1a: the same in all processes
  for (; *filter; ++filter)
  {
    number = (number ^ static_cast<unsigned char>(*filter)) * 16777619u;
  }
  return static_cast<int>(number >> 1);
}

/// Receives who has come until all have, or the time is over, and what has been sent by then: a rank that came too late
/// to the last meeting has withdrawn from it.
void Collect(vtkMPIController* ranks, double wait, std::vector<Word>& come)
{
  const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  const auto missing = [&] { return std::any_of(come.begin(), come.end(), [](const Word& word) { return !word[0]; }); };
  for (int waits = 1; waits || (missing() && !IsPast(start, wait));)
  {
    int from = 0;
    ranks->Iprobe(vtkMultiProcessController::ANY_SOURCE, ComeTag, &waits, &from);
    if (waits)
    {
      ranks->Receive(come[static_cast<std::size_t>(from)].data(), 2, from, ComeTag);
    }
    else
    {
      Rest();
    }
  }
}

/// The first rank collects who has come, and tells them what it decides.
MissingRank Decide(vtkMPIController* ranks, double wait, int filter)
{
  std::vector<Word> come(static_cast<std::size_t>(ranks->GetNumberOfProcesses()), Word{ 0, 0 });
  come[0] = { 1, filter };
  Collect(ranks, wait, come);
  const auto first = [&](auto isAbsent) {
    const auto found = std::find_if(come.begin(), come.end(), isAbsent);
    return found == come.end() ? Nobody : static_cast<int>(found - come.begin());
  };
  MissingRank absence{ first([](const Word& word) { return word[0] == 0; }), false };
  if (absence.rank == Nobody)
  {
    absence.rank = first([&](const Word& word) { return word[1] != filter; });
    absence.elsewhere = absence.rank != Nobody;
  }
  for (std::size_t rank = 1; rank < come.size(); ++rank)
  {
    if (come[rank][0] != 0)
    {
      const Decision decision = { come[rank][0], absence.rank, absence.elsewhere };
      ranks->Send(decision.data(), 3, static_cast<int>(rank), GoTag);
    }
  }
  return absence;
}

/// Others come, and wait for what it decides. One that waits no longer says so; what was decided just then counts.
MissingRank Come(vtkMPIController* ranks, double wait, int filter)
{
  static int meetings = 0;
  const Word own = { ++meetings, filter }, withdrawn = { 0, 0 };
  const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  ranks->Send(own.data(), 2, 0, ComeTag);
  for (bool gone = false; !gone || !IsPast(start, wait + 2.0 * Slack);)
  {
    int waits = 0, from = 0;
    ranks->Iprobe(0, GoTag, &waits, &from);
    if (waits)
    {
      Decision decision = {};
      ranks->Receive(decision.data(), 3, 0, GoTag);
      if (decision[0] == own[0]) // else of a meeting that this rank did not wait for
      {
        return { decision[1], decision[2] != 0 };
      }
      continue;
    }
    if (!gone && IsPast(start, wait + Slack))
    {
      ranks->Send(withdrawn.data(), 2, 0, ComeTag);
      gone = true;
    }
    Rest();
  }
  return { 0, false };
}
#endif
}

double SecondsToWait()
{
  const char* const said = std::getenv("TYNDALL_RANKS_WAIT");
  const double seconds = NumberIn(said ? said : "").value_or(0.0);
  return seconds > 0.0 ? std::min(seconds, LongestWait) : UsualWait;
}

MissingRank FindMissingRank(vtkMultiProcessController* ranks, const char* filter)
{
#ifdef TYNDALL_HAS_MPI
  if (auto* const mpi = vtkMPIController::SafeDownCast(ranks))
  {
    const int number = NumberOf(filter);
    return mpi->GetLocalProcessId() == 0 ? Decide(mpi, SecondsToWait(), number) : Come(mpi, SecondsToWait(), number);
  }
#endif
  (void)ranks;
  (void)filter;
  return {};
}
}
