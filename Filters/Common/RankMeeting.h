#pragma once

class vtkMultiProcessController;

namespace tyndall
{
/// Waits until all ranks are here, which are about to work together, but not forever: a rank on which a filter before
/// gave up (RequestData or RequestInformation returned 0) never comes, for VTK does not run what is after that.
///
/// They wait 600 seconds, or as many as the variable TYNDALL_RANKS_WAIT says: a filter before may take that much longer
/// on one rank than on another. Without MPI nobody waits here.
/// @return -1: all are here; else the first rank that did not come, or 0 on a rank that comes when the others have gone
int MissingRank(vtkMultiProcessController* ranks);

/// As it is now.
double SecondsToWait();
}
