#pragma once

class vtkMultiProcessController;

namespace tyndall
{
/// Waits until all ranks are here, which are about to work together, but not forever: a rank whose script does not
/// update the filter, or where the pipeline stopped before it, never comes.
///
/// They wait 600 seconds, or as many as the variable TYNDALL_RANKS_WAIT says: a filter before may take that much longer
/// on one rank than on another. Without MPI nobody waits here.
/// @return -1: all are here; else the first rank that did not come, or 0 on a rank that comes when the others have gone
int MissingRank(vtkMultiProcessController* ranks);

/// As it is now.
double SecondsToWait();
}
