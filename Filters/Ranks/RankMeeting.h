#pragma once

class vtkMultiProcessController;

namespace tyndall
{
/// Who is not where the others are.
struct MissingRank
{
  int rank = -1; ///< the first that did not come, or 0 on a rank that comes when the others have gone; -1: none
  bool elsewhere = false; ///< it came to another filter than the first rank
};

/// Waits until all ranks are here, which are about to work together, but not forever: a rank whose script does not
/// update the filter, or where the pipeline stopped before it, never comes.
///
/// They wait 600 seconds, or as many as the variable TYNDALL_RANKS_WAIT says: a filter before may take that much longer
/// on one rank than on another. Without MPI nobody waits here.
/// @param filter  that this rank is at: its class
MissingRank FindMissingRank(vtkMultiProcessController* ranks, const char* filter);

/// As it is now.
double SecondsToWait();
}
