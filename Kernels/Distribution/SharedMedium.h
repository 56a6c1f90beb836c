#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/Domain.h"
#include "Light/ChannelReduction.h"
#include "Light/KeptLight.h"
#include "Light/LightField.h"
#include "Medium/Medium.h"
#include "Medium/Traits.h"

#include <string>
#include <vector>

namespace tyndall
{
// The following functions check that ranks agree on properties of a distributed medium, compute properties of the whole
// medium, and share results of a solve. All of them but IsFirstThatHas are collective.

/// Checks that numbers are the same on all ranks. Collective.
/// @param what  description of the numbers, for the message
/// @param has  whether this rank has the numbers; if not, its values are ignored, but their count must be the same
/// @throws InvalidInput on all ranks, if the values differ
void RequireSame(Communicator& communicator, const char* what, bool has, std::vector<double> values);

/// Checks that all ranks have the same grid and partition. Collective.
/// @throws InvalidInput on all ranks, if grids or partitions differ
void RequireSame(Communicator& communicator, const BlockPartition& partition);

/// Whether this rank is the lowest one that has voxels. It alone counts quantities that all ranks with voxels know.
/// Sends no message.
bool IsFirstThatHas(const Communicator& communicator, const BlockPartition& partition);

/// Agrees on the phase function of a distributed medium whose mean cosine g is given by voxel. If g varies among the
/// scattering voxels of all ranks, each rank keeps g by voxel. Otherwise all ranks set the same phase function.
/// Collective.
/// @param has     whether this rank has voxels
/// @param g       g by voxel of this rank; without values, its medium is not changed
/// @param medium  medium of this rank, whose phase function is of the wanted type
void AgreeOnMeanCosine(Communicator& communicator, bool has, const Field& g, Medium& medium);

/// Traits of the whole distributed medium: absorbs, scatters, emits, grey and greyExtinction are reduced over the
/// ranks. Collective.
/// @param ofBlock  traits of this rank's block; other traits than these are returned unchanged
MediumTraits TraitsOfAll(Communicator& communicator, MediumTraits ofBlock);

/// The colour channels that the whole distributed scene needs. Collective.
/// @param here  channels of this rank's block
SceneChannels ChannelsOfAll(const Domain& domain, const SceneChannels& here);

/// Replaces each power by its sum over the ranks, in one reduction. Collective.
void SumOverRanks(const Domain& domain, const std::vector<Rgb*>& powers);

/// Broadcasts the scalar results of a solve on one rank to all ranks: channels, numbers of directions, energy balance,
/// face powers, half-range flux, convergence, saved sweeps, device and leftOut. Neither arrays nor warnings are sent.
/// Collective.
/// @param found  true on the one rank that has the result
/// @param light  the result on that rank; receives it on the others
void ShareFigures(Communicator& communicator, bool found, LightField& light);

/// Sets `light.leftOut` on all ranks to the value of the first rank that has voxels. Collective.
void ShareLeftOut(const Domain& domain, LightField& light);

/// Reason why a distributed solve cannot start from kept light, the same text on all ranks; empty if it can. Each rank
/// keeps the light of its block; if one rank cannot start from it, none does. Collective.
/// @param whyNot  the reason on this rank, from WhyNotBegun
std::string WhyNotBegunOnAny(Communicator& communicator, const KeptLight& kept, const std::string& whyNot);
}
