#pragma once

#include <vector>

class vtkMPIController;

namespace tyndall
{
/// What each rank has for some others, and what they have for it, all at once: an exchange of DIY's, of one block a
/// rank. All ranks call it. Of any length: DIY cuts messages into parts of 2 GiB.
///
/// DIY waits for others as long as it takes. So ranks agree before that none of them fails (Communicator::Exchange).
/// One that has not heard of others within the time, or cannot hold what comes, ends its process, and MPI those of
/// all: none hangs.
/// @param with  ranks that have something for each other, if only nothing; not this one
/// @param parcels  one for each of them
/// @param patience  seconds
/// @return by the ranks of `with`
std::vector<std::vector<char>> ExchangeByDIY(
  vtkMPIController* controller, const std::vector<int>& with, std::vector<std::vector<char>> parcels, double patience);
}
