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
// Properties of a distributed medium that must agree on all ranks, and global properties. All functions but
// IsFirstThatHas are collective.

/// @param what  what the numbers are, for the message
/// @param has  whether this rank has numbers; if not, its values are ignored but must be as many
/// @throws InvalidInput on all ranks, if the values differ
void RequireSame(Communicator& communicator, const char* what, bool has, std::vector<double> values);

/// @throws InvalidInput on all ranks, if the ranks disagree about the grid or its partition
void RequireSame(Communicator& communicator, const BlockPartition& partition);

/// Whether this rank is the lowest one that has voxels, which counts what all ranks with voxels know. Sends no message.
bool IsFirstThatHas(const Communicator& communicator, const BlockPartition& partition);

/// Phase function of a distributed medium with g by voxel: if g varies among the scattering voxels of all ranks, each
/// rank keeps g by voxel; else all get the same phase function. Collective.
/// @param has   whether this rank has voxels
/// @param g  g by voxel of this rank; without values, its medium stays as it is
/// @param medium  medium of this rank, whose phase function is of the wanted kind
void AgreeOnMeanCosine(Communicator& communicator, bool has, const Field& g, Medium& medium);

/// Traits of the whole distributed medium: absorbs, scatters, emits, grey and greyExtinction.
/// @param ofBlock  traits of this rank's block; those not named above are kept
MediumTraits TraitsOfAll(Communicator& communicator, MediumTraits ofBlock);

/// The channels of a distributed scene.
/// @param here  channels of this rank's block
SceneChannels ChannelsOfAll(const Domain& domain, const SceneChannels& here);

/// Replaces each power by its sum over ranks, in one reduction. Collective.
void SumOverRanks(const Domain& domain, const std::vector<Rgb*>& powers);
}
