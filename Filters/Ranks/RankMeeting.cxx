#include "Ranks/RankMeeting.h"

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
constexpr int Nobody = -1;
constexpr double UsualWait = 600.0, LongestWait = 1e8; ///< seconds; clocks count no longer than centuries

#ifdef TYNDALL_HAS_MPI
constexpr int ComeTag = 745203, GoTag = 745204; ///< of messages to the first rank, and from it
constexpr double Slack = 5.0;                   ///< seconds that others wait longer than the first rank, which decides

using Clock = std::chrono::steady_clock;

bool IsPast(const Clock::time_point& start, double seconds)
{
  return std::chrono::duration<double>(Clock::now() - start).count() > seconds;
}

void Rest()
{
  std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// The number of a meeting as its ranks count, each its own; 0: withdrawn.
using Number = int;

/// The first rank collects who has come, and tells them what it decides.
int Decide(vtkMPIController* ranks, double wait)
{
  const auto count = static_cast<std::size_t>(ranks->GetNumberOfProcesses());
  std::vector<Number> come(count, 0);
  come[0] = 1;
  const Clock::time_point start = Clock::now();
  const auto missing = [&] { return std::find(come.begin(), come.end(), 0); };
  while (missing() != come.end() && !IsPast(start, wait))
  {
    int waits = 0, from = 0;
    ranks->Iprobe(vtkMultiProcessController::ANY_SOURCE, ComeTag, &waits, &from);
    if (waits)
    {
      ranks->Receive(&come[static_cast<std::size_t>(from)], 1, from, ComeTag);
    }
    else
    {
      Rest();
    }
  }
  const int first = missing() == come.end() ? Nobody : static_cast<int>(missing() - come.begin());
  for (std::size_t rank = 1; rank < count; ++rank)
  {
    if (come[rank] != 0)
    {
      const std::array<int, 2> decision = { come[rank], first };
      ranks->Send(decision.data(), 2, static_cast<int>(rank), GoTag);
    }
  }
  return first;
}

/// Others come, and wait for what it decides. One that waits no longer says so; what was decided just then counts.
int Come(vtkMPIController* ranks, double wait)
{
  static Number meetings = 0;
  const Number own = ++meetings;
  const Number withdrawn = 0;
  const Clock::time_point start = Clock::now();
  ranks->Send(&own, 1, 0, ComeTag);
  for (bool gone = false; !gone || !IsPast(start, wait + 2.0 * Slack);)
  {
    int waits = 0, from = 0;
    ranks->Iprobe(0, GoTag, &waits, &from);
    if (waits)
    {
      std::array<int, 2> decision = {};
      ranks->Receive(decision.data(), 2, 0, GoTag);
      if (decision[0] == own) // else of a meeting that this rank did not wait for
      {
        return decision[1];
      }
      continue;
    }
    if (!gone && IsPast(start, wait + Slack))
    {
      ranks->Send(&withdrawn, 1, 0, ComeTag);
      gone = true;
    }
    Rest();
  }
  return 0;
}
#endif
}

double SecondsToWait()
{
  const char* const said = std::getenv("TYNDALL_RANKS_WAIT");
  const double seconds = said ? std::atof(said) : 0.0;
  return seconds > 0.0 ? std::min(seconds, LongestWait) : UsualWait;
}

int MissingRank(vtkMultiProcessController* ranks)
{
#ifdef TYNDALL_HAS_MPI
  if (auto* const mpi = vtkMPIController::SafeDownCast(ranks))
  {
    return mpi->GetLocalProcessId() == 0 ? Decide(mpi, SecondsToWait()) : Come(mpi, SecondsToWait());
  }
#endif
  (void)ranks;
  return Nobody;
}
}
