#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/Domain.h"
#include "Light/ChannelReduction.h"
#include "Medium/Medium.h"
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

/// How a medium whose g is given by voxel scatters: each rank has g by voxel where it varies among the voxels of all
/// ranks that scatter, else the same phase function as the others. Collective.
/// @param has     voxels
/// @param g       of the rank's voxels; without values the rank has none, and its medium stays as it is
/// @param medium  of the rank, whose phase function is of the kind wanted
void AgreeOnMeanCosine(Communicator& communicator, bool has, const Field& g, Medium& medium);

/// Of the medium of all ranks, as far as solvers leave things out: absorbs, scatters, emits, grey and greyExtinction.
/// @param ofBlock  the others of it are kept
MediumTraits TraitsOfAll(Communicator& communicator, MediumTraits ofBlock);

/// The channels of a scene of which each rank has a block.
/// @param here  of this rank's block
SceneChannels ChannelsOfAll(const Domain& domain, const SceneChannels& here);
}
