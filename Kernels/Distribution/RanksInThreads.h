#pragma once

#include "Distribution/Communicator.h"

#include <functional>

namespace tyndall
{
/// Runs `work` on ranks that are threads of this process, each with its own communicator, and waits for all of them: a
/// distributed solve on a single machine.
/// @param ranks  at least 1
/// @param patience  seconds that a rank waits for a message before it fails with an error, so that none hangs
/// @throws the error of the lowest rank that threw, after all have ended
void RunInThreads(int ranks, const std::function<void(Communicator&)>& work, double patience = 60.0);
}
