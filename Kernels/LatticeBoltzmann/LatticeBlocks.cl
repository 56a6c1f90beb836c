// Steps in blocks of voxels that exchange light only after several steps (Bernabei et al., section III-C). The host
// defines
//   BLOCK  number of voxels along a block's edge
#include "LatticeBoltzmann/LatticeLink.cl"

#define IN_BLOCK (BLOCK * BLOCK * BLOCK)
DEFINE_ARRIVING(arriving, float)
DEFINE_COLLIDED(collided, float)
DEFINE_OPEN(open_weight, float, int)
DEFINE_SENT(sent_weight, float, int)

// Index within the block of the neighbour at `sign` times the link vector i; -1 if it is in another block or outside
// the box.
static int neighbour_in_block(LatticeInfo lattice, int i, int sign)
{
  int index = 0, step = 1;
  for (int a = 0; a < 3; ++a)
  {
    const int next = (int)get_local_id(a) + sign * Ways[i][a], at = (int)get_global_id(a) + sign * Ways[i][a];
    if (next < 0 || next >= BLOCK || at >= lattice.size[a])
    {
      return -1;
    }
    index += step * next;
    step *= BLOCK;
  }
  return index;
}

// Takes lattice.steps steps in each block independently. One work-group per block, one work-item per voxel. Arrays are
// those of step_lattice, and
//   came       densities that other blocks, or the boundary, send into the block per step: mean over the steps before
//              the last exchange
//   goes       densities that this block sends to other blocks per step, for the next exchange: mean over these steps.
//              Values of links within the block are not changed.
//   densities  of all voxels, before and after the steps
__kernel __attribute__((reqd_work_group_size(BLOCK, BLOCK, BLOCK))) void step_blocks(LatticeInfo lattice,
  const __global float* resistance, const __global float* squared, const __global float* albedo,
  const __global float* turning, const __global float* kept, const __global float* source,
  const __global float* endless, const __global float* came, __global float* goes, __global float* densities,
  __global float* fluence)
{
  __local float block[DIRECTIONS * IN_BLOCK];
  const int x = get_global_id(0), y = get_global_id(1), z = get_global_id(2);
  const int me = (get_local_id(2) * BLOCK + get_local_id(1)) * BLOCK + get_local_id(0);
  const bool exists = x < lattice.size[0] && y < lattice.size[1] && z < lattice.size[2];
  const ulong at = exists ? (ulong)(z + 1) * lattice.layer + (ulong)(y + 1) * lattice.row + x + LatticeFirst : 0;
  const float half_source = 0.5f * source[at], even = turning[at], stays = kept[at];
  const float own = PASSES_ALL ? 1.0f : resistance[at], index = BENDS ? squared[at] : 1.0f;
  const int closed = ENDLESS ? (int)endless[at] : 0;
  const float open = open_weight(closed);
  float here[DIRECTIONS], mean[DIRECTIONS], sum = 0.0f;
  FOR_DIRECTIONS(i)
  {
    block[i * IN_BLOCK + me] = densities[i * lattice.stride + at];
    mean[i] = 0.0f;
  }
  barrier(CLK_LOCAL_MEM_FENCE);
  for (int step = 0; step < lattice.steps; ++step)
  {
    sum = half_source;
    FOR_DIRECTIONS(i)
    {
      const int from = exists ? neighbour_in_block(lattice, i, -1) : me;
      const ulong other = exists ? at - lattice.offset[i] : at;
      here[i] = arriving(from >= 0 ? block[i * IN_BLOCK + from] : came[i * lattice.stride + other],
        block[(i ^ 1) * IN_BLOCK + me], own, PASSES_ALL ? 1.0f : resistance[other], index,
        BENDS ? squared[other] : 1.0f, REFLECTS ? albedo[other] : 0.0f);
      sum += here[i];
    }
    barrier(CLK_LOCAL_MEM_FENCE);
    FOR_DIRECTIONS(i)
    {
      const float weight = sent_weight(i, closed, open), half_own = weight * half_source;
      const float after = collided(weight, here[i] + half_own, sum, even, stays) + half_own;
      block[i * IN_BLOCK + me] = after;
      mean[i] += after;
    }
    barrier(CLK_LOCAL_MEM_FENCE);
  }
  if (exists)
  {
    FOR_DIRECTIONS(i)
    {
      densities[i * lattice.stride + at] = block[i * IN_BLOCK + me];
      if (neighbour_in_block(lattice, i, 1) < 0)
      {
        goes[i * lattice.stride + at] = mean[i] / (float)lattice.steps;
      }
    }
    fluence[((ulong)z * lattice.size[1] + y) * lattice.size[0] + x] = sum;
  }
}
