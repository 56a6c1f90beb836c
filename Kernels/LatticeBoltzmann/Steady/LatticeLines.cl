// Light that goes along lines of links, until it collides, for collisions that are known (numerics.md, Eqs. (L7) to
// (L10)). The host gives what LatticeLink.cl and Numerics/Exact.cl want.
//
// Along a line light goes both ways, for links give back a part. What lies behind a voxel is known by what it sends
// whatever happens ahead, U, and by what it gives back of what comes from ahead, R: two numbers a voxel, found on the
// way up; densities follow on the way down. All terms are positive, so that no digit is lost.
#include "LatticeBoltzmann/Steady/LatticeLine.cl"

// What comes down to where a closed line is cut, by what goes round up it, x, and what comes from ahead, B: sent +
// round x + gives_back B.
typedef struct
{
  exact sent, round, gives_back;
} Cut;

// Lines of a pair of directions, 2 pair and 2 pair + 1. A work-item a line.
//   shines    1, or 0: nothing comes in through the faces
//   behind    [voxel][2], scratch
//   share     [voxel], scratch: of closed lines, how much more a voxel sends by what goes round, T
//   sum       [voxel], W / length^2: what arrives is added
//   writes    1: densities are written, too, as step_lattice has them
__kernel void sweep_lines(LatticeInfo lattice, MEDIUM, int pair, exact shines, __global exact* behind,
  __global exact* share, __global exact* sum, __global float* densities, int writes)
{
  const int i = 2 * pair;
  const exact weight = EXACT_WEIGHT(i);
  Place place;
  bool closed;
  if (!begin_line(lattice, i, &place, &closed))
  {
    return;
  }
  const Place first = place;
  const ulong first_voxel = voxel_at(lattice, place.at);
  const Place before = next_along(lattice, place, i + 1);
  ulong voxel = first_voxel;
  Link link = { 0, 0 };
  Border low = { 0, 0 };
  exact arrived, back, part = 0; // from behind; `part` of what goes round
  if (closed)
  {
    link = link_between(straight, passes, squared, even, voxel_at(lattice, before.at), voxel);
    arrived = 0;
    back = 1 - link.down;
    part = link.up;
  }
  else
  {
    low = border_at(lattice, straight, passes, squared, even, voxel, before, shines, i);
    arrived = low.in;
    back = low.back;
  }
  const Link closing = link;
  Cut cut = { weight * even[voxel], 0, straight[voxel] };
  int voxels = 1;
  for (;;)
  {
    const Behind here = pass_voxel(straight[voxel], weight * even[voxel], arrived, back);
    behind[2 * voxel] = here.sends;
    behind[2 * voxel + 1] = here.returns;
    if (closed)
    {
      part *= straight[voxel];
      share[voxel] = part;
    }
    const Place next = next_along(lattice, place, i);
    const ulong ahead = voxel_at(lattice, next.at);
    if (next.face >= 0 || (closed && ahead == first_voxel))
    {
      break;
    }
    link = link_between(straight, passes, squared, even, voxel, ahead);
    if (closed)
    {
      const exact again = 1 / (1 - here.returns * (1 - link.up));
      const exact down = cut.gives_back * again;
      cut.sent += down * (link.down * weight * even[ahead] + (1 - link.up) * here.sends);
      cut.round += down * (1 - link.up) * part;
      cut.gives_back = down * link.down * straight[ahead];
      part *= link.up * again;
    }
    const Behind beyond = cross_up(link, here);
    arrived = beyond.sends;
    back = beyond.returns;
    place = next;
    voxel = ahead;
    ++voxels;
  }

  // What comes down to the last voxel, and what goes round a closed line.
  const exact sends = behind[2 * voxel], returns = behind[2 * voxel + 1];
  exact comes, round = 0;
  if (closed)
  {
    const exact again = 1 / (1 - closing.down * cut.gives_back);
    const exact down = closing.down * cut.sent * again, of_round = (closing.down * cut.round + 1 - closing.up) * again;
    const exact rest = 1 - part - returns * of_round;
    round = rest > 0 ? (sends + returns * down) / rest : 0;
    comes = down + of_round * round;
  }
  else
  {
    const Border high =
      border_at(lattice, straight, passes, squared, even, voxel, next_along(lattice, place, i), shines, i);
    const exact rest = 1 - high.back * returns;
    comes = rest > 0 ? (high.in + high.back * sends) / rest : 0;
  }
  for (; voxels > 0; --voxels)
  {
    const exact source = weight * even[voxel], down = straight[voxel] * comes + source;
    exact up_arrives;
    if (voxels > 1)
    {
      const Place below = next_along(lattice, place, i + 1);
      const ulong other = voxel_at(lattice, below.at);
      link = link_between(straight, passes, squared, even, other, voxel);
      const Behind of_other = { behind[2 * other] + (closed ? share[other] * round : 0), behind[2 * other + 1] };
      const Crossed crossed = cross_down(link, of_other, down);
      up_arrives = crossed.up_arrives;
      sum[voxel] += up_arrives + comes;
      if (writes)
      {
        const ulong at = density_at(lattice, place.at);
        densities[i * lattice.stride + at] = straight[voxel] * up_arrives + source;
        densities[(i + 1) * lattice.stride + at] = down;
      }
      comes = crossed.lower;
      place = below;
      voxel = other;
    }
    else
    {
      up_arrives = closed ? closing.up * round + (1 - closing.down) * down : low.in + low.back * down;
      sum[voxel] += up_arrives + comes;
      if (writes)
      {
        const ulong at = density_at(lattice, first.at);
        densities[i * lattice.stride + at] = straight[voxel] * up_arrives + source;
        densities[(i + 1) * lattice.stride + at] = down;
      }
    }
  }
}
