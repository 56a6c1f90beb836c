#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Refraction/Octree/RefractionOctree.h"

namespace tyndall
{
/// BuildOctree of a medium that is spread over ranks by blocks: the levels are those of the whole, whatever the blocks.
/// All ranks call it.
///
/// Nodes are those of the whole grid, and a node is of the rank that its first voxel is of. Ranks send each other the
/// ranges of nodes that lie in several blocks, from level to level up, and which of them are kept whole down again: of
/// a block's surface, and so little that it is done on the host (numerics.md, section 11.4).
///
/// @param partition  as many blocks as ranks
/// @param medium, index  of the rank's block, with the grid that partition.OwnGrid() has; looked at by nobody where
///   that has no voxels
/// @return levels of the rank's block; the rest is of the whole, and `device` empty
/// @throws InvalidInput  on every rank what BuildOctree throws on one of them; Aborted
Octree BuildOctreeInBlocks(Communicator& communicator, const BlockPartition& partition, const Medium& medium,
  const Field& index, const OctreeSettings& settings, const Monitor& monitor = {});
}
