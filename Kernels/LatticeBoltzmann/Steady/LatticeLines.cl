// Light that moves along lines of links until it collides, for given collisions (numerics.md, Eqs. (L7) to (L10)). The
// host gives what LatticeLink.cl and Numerics/Exact.cl require.
//
// Along a line light moves both ways, for links give back a part. The voxels up to one of them are described by what
// they send without light from ahead, U, and the part of light from ahead that they return, R: two numbers a voxel,
// found on the way up; densities follow on the way down. All terms are positive, so that no digit is lost.
#include "LatticeBoltzmann/Steady/LatticeLine.cl"

// Lines of a pair of directions, 2 pair and 2 pair + 1. A work-item a line.
//   incident  1, or 0: no incident light
//   behind    [voxel][2], scratch
//   share     [voxel], scratch: T of closed lines, a voxel's response to what wraps around
//   sum       [voxel], W / length^2: what arrives is added
//   endless   [voxel], with ENDLESS: bits of the pairs along which its lines are endless, which stay dark
//   writes    1: densities are written, too, as step_lattice has them
__kernel void sweep_lines(LatticeInfo lattice, MEDIUM, int pair, exact incident, __global exact* behind,
  __global exact* share, __global exact* sum, __global float* densities, const __global float* endless, int writes)
{
  const int i = 2 * pair;
  Place place;
  bool closed;
  if (!begin_line(lattice, i, &place, &closed))
  {
    return;
  }
  const ulong voxel = voxel_at(lattice, place.at);
  if (is_endless(endless, voxel, pair))
  {
    return;
  }
  const Place before = next_along(lattice, place, i + 1);
  Link closing = { 0, 0 };
  Border low = { 0, 0 };
  if (closed)
  {
    closing = link_between(straight, passes, squared, even, voxel_at(lattice, before.at), voxel);
  }
  else
  {
    low = border_at(lattice, straight, passes, squared, even, voxel, before, incident, i);
  }
  const Beginning begin = closed ? begin_at_cut(closing) : begin_at_border(low);
  const Top top = go_up(lattice, straight, passes, squared, even, place, i, begin, closed, behind, share);

  // What is sent down to the last voxel, and what wraps around a closed line.
  const exact sends = behind[2 * top.voxel], returns = behind[2 * top.voxel + 1];
  exact comes, round = 0;
  if (closed)
  {
    const exact again = 1 / (1 - closing.down * top.cut.gives_back);
    const exact down = closing.down * top.cut.sent * again;
    const exact of_round = (closing.down * top.cut.round + 1 - closing.up) * again;
    const exact rest = 1 - top.part - returns * of_round;
    round = rest > 0 ? (sends + returns * down) / rest : 0;
    comes = down + of_round * round;
    low.in = closing.up * round;
    low.back = 1 - closing.down;
  }
  else
  {
    const Place past = next_along(lattice, top.place, i);
    const Border high = border_at(lattice, straight, passes, squared, even, top.voxel, past, incident, i);
    const exact rest = 1 - high.back * returns;
    comes = rest > 0 ? (high.in + high.back * sends) / rest : 0;
  }
  go_down(
    lattice, straight, passes, squared, even, top, i, comes, round, low, closed, behind, share, sum, densities, writes);
}
