#pragma once

namespace tyndall
{
/// Processes of this MPI run on this machine, as its launcher says; where it does not, those of VTK's global controller.
int RanksOnThisMachine();

/// Whether each of as many processes can take memory on this machine, of what it has available now (AvailableMemory.h).
bool FitsOnEach(int processes, double bytes);
}
