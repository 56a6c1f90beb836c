// Streaming along lines of links between collisions, for given collisions (numerics.md, Eqs. (L7) to (L10)). The host
// defines what LatticeLink.cl and Numerics/Exact.cl require.
//
// Light moves both ways along a line, because links reflect a part. The voxels up to a given one are described by U,
// what they send up without light from ahead, and R, the fraction of light from ahead that they return. The upward pass
// finds U and R of every voxel, the downward pass the densities. All terms are positive, so that there is no
// cancellation.
#include "LatticeBoltzmann/Steady/LatticeLine.cl"

// Solves all lines of the directions 2 pair and 2 pair + 1. One work-item per line.
//   incident  factor of the incident light, 1 or 0
//   behind    [voxel][2], scratch
//   share     [voxel], scratch: T of closed lines, the voxel's response to light that wraps around
//   sum       [voxel], W / length^2: arriving light is added
//   endless   [voxel], with ENDLESS: bit mask of the direction pairs whose line is endless; such lines carry no light
//   writes    1: also write densities, in the layout of step_lattice
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

  // Light sent down to the last voxel, and light that wraps around a closed line.
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
