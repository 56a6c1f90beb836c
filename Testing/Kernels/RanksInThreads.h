#pragma once

#include "Distribution/Communicator.h"

#include <functional>

namespace tyndall
{
/// Runs `work` on several ranks, which are threads of this process with one communicator each, and waits for all of
/// them: a distributed solve on a single machine.
/// @param ranks  number of ranks, at least 1
/// @param patience  seconds that a rank waits for a message before it fails with an error, so that none waits forever
/// @throws the error of the lowest rank that threw, after all ranks have ended
void RunInThreads(int ranks, const std::function<void(Communicator&)>& work, double patience = 60.0);
}
