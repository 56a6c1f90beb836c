#pragma once

#include "Distribution/Communicator.h"

#include <functional>

namespace tyndall
{
/// Runs `work` on ranks that are threads of this process, each with its communicator, and waits for all: what is meant
/// for several machines, on one.
/// @param ranks  at least 1
/// @param patience  seconds that a rank waits for a message before it gives up with an error: none hangs
/// @throws what the first rank that threw did, when all have come to their end
void RunInThreads(int ranks, const std::function<void(Communicator&)>& work, double patience = 60.0);
}
