#pragma once

#include "Distribution/Communicator.h"
#include "Photons/Photons.h"

namespace tyndall
{
// What this rank has counted of photons to the sums of all ranks. All ranks call these.

/// Of photons up to where they are first scattered: what became of their power, and how far they went.
void AddUpTallies(Communicator& communicator, PhotonLight& result);

/// Of photons that were scattered.
void AddUpScattered(Communicator& communicator, PhotonLight& result);
}
