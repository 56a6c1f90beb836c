#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Medium/Traits.h"

#include <vector>

namespace tyndall
{
// What ranks that share a medium by blocks must have alike, and what they have together. All ranks call these.

/// @param what  these numbers are, for the message
/// @param has   numbers; those of a rank that has none are not looked at, but are as many
/// @throws InvalidInput  on each, where they differ
void RequireSame(Communicator& communicator, const char* what, bool has, std::vector<double> values);

/// @throws InvalidInput  on each, where they differ in the grid and who has which part of it
void RequireSame(Communicator& communicator, const BlockPartition& partition);

/// Whether a rank is the first that has voxels: who counts what all know but ranks without voxels. No message is sent.
bool IsFirstThatHas(const Communicator& communicator, const BlockPartition& partition);

/// Of the medium of all ranks, as far as solvers leave things out: absorbs, scatters, emits, grey and greyExtinction.
/// @param ofBlock  the others of it are kept
MediumTraits TraitsOfAll(Communicator& communicator, MediumTraits ofBlock);
}
