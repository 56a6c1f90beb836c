// Lines of links through a rank's block: the way up and the way down of sweep_lines, between which other blocks' ways
// are. Lines are open.
#include "LatticeBoltzmann/Steady/LatticeLine.cl"

#define LINE (get_global_id(1) * get_global_size(0) + get_global_id(0))

// What the block before says of its last voxel on a line: U, R, what links let through, n^2.
static Link link_to_block(MEDIUM, const __global exact* before, ulong line, ulong voxel)
{
  return link_of(before[4 * line + 2], passes[voxel], before[4 * line + 3], BENDS ? squared[voxel] : 1);
}

// Up the lines of a pair of directions. A work-item a line; arrays as of sweep_lines, and
//   before  [line][4], see above, where the line comes from another block
//   last    the same of this block's last voxels
__kernel void lines_up(LatticeInfo lattice, MEDIUM, int pair, exact shines, const __global exact* before,
  __global exact* behind, __global exact* last)
{
  const int i = 2 * pair;
  const exact weight = EXACT_WEIGHT(i);
  Place place;
  bool closed;
  if (!begin_line(lattice, i, &place, &closed))
  {
    return;
  }
  const ulong line = LINE;
  const Place low = next_along(lattice, place, i + 1);
  ulong voxel = voxel_at(lattice, place.at);
  Behind arrives, here;
  if (low.face == OtherBlock)
  {
    const Behind there = { before[4 * line], before[4 * line + 1] };
    arrives = cross_up(link_to_block(straight, passes, squared, even, before, line, voxel), there);
  }
  else
  {
    const Border border = border_at(lattice, straight, passes, squared, even, voxel, low, shines, i);
    arrives.sends = border.in;
    arrives.returns = border.back;
  }
  for (;;)
  {
    here = pass_voxel(straight[voxel], weight * even[voxel], arrives.sends, arrives.returns);
    behind[2 * voxel] = here.sends;
    behind[2 * voxel + 1] = here.returns;
    const Place next = next_along(lattice, place, i);
    if (next.face >= 0)
    {
      break;
    }
    const ulong ahead = voxel_at(lattice, next.at);
    arrives = cross_up(link_between(straight, passes, squared, even, voxel, ahead), here);
    place = next;
    voxel = ahead;
  }
  last[4 * line] = here.sends;
  last[4 * line + 1] = here.returns;
  last[4 * line + 2] = passes[voxel];
  last[4 * line + 3] = BENDS ? squared[voxel] : 1;
}

// Down them, after lines_up.
//   after  [line][2], what comes down to the block's last voxel, and what the one beyond sends, where that is another
//          block's
//   first  the same for the block before
//   densities  those of the voxels beyond, too, on the way to these
__kernel void lines_down(LatticeInfo lattice, MEDIUM, int pair, exact shines, const __global exact* before,
  const __global exact* behind, const __global exact* after, __global exact* first, __global exact* sum,
  __global float* densities, int writes)
{
  const int i = 2 * pair;
  const exact weight = EXACT_WEIGHT(i);
  Place place;
  bool closed;
  if (!begin_line(lattice, i, &place, &closed))
  {
    return;
  }
  const ulong line = LINE;
  int ways = INT_MAX;
  for (int a = 0; a < 3; ++a)
  {
    const int ahead = Ways[i][a] > 0 ? lattice.size[a] - 1 - place.at[a] : place.at[a];
    ways = Ways[i][a] != 0 ? min(ways, ahead) : ways;
  }
  for (int a = 0; a < 3; ++a)
  {
    place.at[a] += ways * Ways[i][a];
  }
  ulong voxel = voxel_at(lattice, place.at);
  const Place high = next_along(lattice, place, i);
  exact comes;
  if (high.face == OtherBlock)
  {
    comes = after[2 * line];
    if (writes)
    {
      densities[(i + 1) * lattice.stride + density_at(lattice, place.at) + lattice.offset[i]] = after[2 * line + 1];
    }
  }
  else
  {
    const Border border = border_at(lattice, straight, passes, squared, even, voxel, high, shines, i);
    const exact rest = 1 - border.back * behind[2 * voxel + 1];
    comes = rest > 0 ? (border.in + border.back * behind[2 * voxel]) / rest : 0;
  }
  for (bool ends = false; !ends;)
  {
    const exact source = weight * even[voxel], down = straight[voxel] * comes + source;
    const Place low = next_along(lattice, place, i + 1);
    ulong other = voxel;
    Crossed crossed = { 0, 0, 0 };
    ends = low.face >= 0;
    if (!ends)
    {
      other = voxel_at(lattice, low.at);
      const Behind below = { behind[2 * other], behind[2 * other + 1] };
      crossed = cross_down(link_between(straight, passes, squared, even, other, voxel), below, down);
    }
    else if (low.face == OtherBlock)
    {
      const Behind below = { before[4 * line], before[4 * line + 1] };
      crossed = cross_down(link_to_block(straight, passes, squared, even, before, line, voxel), below, down);
      first[2 * line] = crossed.lower;
      first[2 * line + 1] = down;
    }
    else
    {
      const Border border = border_at(lattice, straight, passes, squared, even, voxel, low, shines, i);
      crossed.up_arrives = border.in + border.back * down;
    }
    sum[voxel] += crossed.up_arrives + comes;
    if (writes)
    {
      const ulong at = density_at(lattice, place.at);
      densities[i * lattice.stride + at] = straight[voxel] * crossed.up_arrives + source;
      densities[(i + 1) * lattice.stride + at] = down;
      if (low.face == OtherBlock)
      {
        densities[i * lattice.stride + at - lattice.offset[i]] = crossed.up;
      }
    }
    comes = crossed.lower;
    place = low;
    voxel = other;
  }
}
