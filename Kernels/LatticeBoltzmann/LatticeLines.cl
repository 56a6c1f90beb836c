// Light that goes along lines of links, until it collides, for collisions that are known (numerics.md, Eqs. (L7) to
// (L10)). The host gives what LatticeLink.cl and Numerics/Exact.cl want.
//
// Along a line light goes both ways, for links give back a part. What lies behind a voxel is known by what it sends
// whatever happens ahead, U, and by what it gives back of what comes from ahead, R: two numbers a voxel, found on the
// way up; densities follow on the way down. All terms are positive, so that no digit is lost.
#include "LatticeBoltzmann/LatticeLink.cl"
#include "Numerics/Exact.cl"

// Of floats, which add up to 1 only to 1e-8, thick voxels would gain or lose as much in every collision.
#define EXACT_WEIGHT(i) (DIRECTIONS == 6 ? (exact)1 / 6 : (i) < 6 ? (exact)1 / 12 : (exact)1 / 24)

// By voxel: part of the density that goes straight on, part that links let through, n^2, and W / length^2 that each
// collision makes even.
#define MEDIUM                                                                                 \
  const __global exact *straight, const __global float *passes, const __global float *squared, \
    const __global exact *even

typedef struct
{
  int at[3];
  int face;  // of the box that was passed, -1: none. Then `at` is the last voxel
  int other; // of a corner the second one, else the same
} Place;

// Parts of light that pass a link up the line and down it.
typedef struct
{
  exact up, down;
} Link;

static ulong voxel_at(LatticeInfo lattice, const int* at)
{
  return ((ulong)at[2] * lattice.size[1] + at[1]) * lattice.size[0] + at[0];
}

static Place next_along(LatticeInfo lattice, Place place, int i)
{
  Place next = place;
  for (int a = 0; a < 3; ++a)
  {
    const int size = lattice.size[a], to = place.at[a] + Ways[i][a];
    const bool beyond = to < 0 || to >= size, periodic = lattice.periodic >> a & 1;
    next.other = beyond && !periodic ? 2 * a + (to < 0 ? 0 : 1) : next.other;
    next.face = next.face < 0 ? next.other : next.face;
    next.at[a] = beyond ? (to + size) % size : to;
  }
  if (next.face >= 0)
  {
    for (int a = 0; a < 3; ++a)
    {
      next.at[a] = place.at[a];
    }
  }
  return next;
}

static Link link_between(MEDIUM, ulong a, ulong b)
{
  const exact own = 1 / (exact)passes[a], other = 1 / (exact)passes[b];
  const exact by_a = BENDS ? 1 / (exact)squared[a] : 1, by_b = BENDS ? 1 / (exact)squared[b] : 1;
  const exact both = 2 / (own * by_a + other * by_b + fabs(by_a - by_b));
  const Link link = { fmin(both * by_a, (exact)1), fmin(both * by_b, (exact)1) };
  return link;
}

// Of a face, or the mean of a corner's two: what it lets in of what shines on it, and the part of what meets it from
// inside that comes back.
typedef struct
{
  exact in, back;
} Border;

static Border border_at(LatticeInfo lattice, MEDIUM, ulong voxel, Place past, exact shines, int i)
{
  const exact incoming = 0.5f * (lattice.incoming[past.face] + lattice.incoming[past.other]);
  const exact albedo = 0.5f * (lattice.albedo[past.face] + lattice.albedo[past.other]);
  const exact passing = 2 / (1 / (exact)passes[voxel] + 1);
  const Border border = { passing * shines * EXACT_WEIGHT(i) * incoming * (BENDS ? squared[voxel] : 1.0f),
    1 - passing * (1 - albedo) };
  return border;
}

// Where the work-item's line begins, and whether there is one: of an axis' links by the two other coordinates, of
// diagonal ones by the coordinate along the third axis and a number along the first rows of the plane.
static bool begin_line(LatticeInfo lattice, int i, Place* place, bool* closed)
{
  const int u = get_global_id(0), v = get_global_id(1);
  int moving[2] = { -1, -1 }, moves = 0, still[2], stills = 0;
  for (int a = 0; a < 3; ++a)
  {
    if (Ways[i][a] != 0)
    {
      moving[moves++] = a;
    }
    else
    {
      still[stills++] = a;
    }
  }
  place->face = place->other = -1;
  const int a = moving[0], b = moving[1];
  const bool round_a = lattice.periodic >> a & 1, round_b = moves > 1 ? lattice.periodic >> b & 1 : true;
  const int first_a = Ways[i][a] > 0 ? 0 : lattice.size[a] - 1;
  *closed = round_a && round_b;
  if (moves == 1)
  {
    place->at[still[0]] = u;
    place->at[still[1]] = v;
    place->at[a] = first_a;
    return true;
  }
  const int size_a = lattice.size[a], size_b = lattice.size[b], first_b = Ways[i][b] > 0 ? 0 : size_b - 1;
  place->at[still[0]] = v;
  if (*closed)
  {
    int x = size_a, y = size_b;
    while (y > 0)
    {
      const int rest = x % y;
      x = y;
      y = rest;
    }
    place->at[a] = u;
    place->at[b] = 0;
    return u < x;
  }
  place->at[a] = u < size_a ? u : first_a;
  place->at[b] = u < size_a ? first_b : u - size_a;
  return u < size_a ? !round_b : !round_a && (round_b || u - size_a != first_b);
}

// What the way up knows of a voxel: U and R.
typedef struct
{
  exact sends, returns;
} Behind;

// What comes down to where a closed line is cut, by what goes round up it, x, and what comes from ahead, B: sent +
// round x + gives_back B.
typedef struct
{
  exact sent, round, gives_back;
} Cut;

// One voxel up: what arrives there from behind is arrived + back times what it sends down.
static Behind pass_voxel(exact straight, exact source, exact arrived, exact back)
{
  const Behind behind = { straight * (arrived + back * source) + source, straight * straight * back };
  return behind;
}

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
    const exact again = 1 / (1 - here.returns * (1 - link.up));
    if (closed)
    {
      const exact down = cut.gives_back * again;
      cut.sent += down * (link.down * weight * even[ahead] + (1 - link.up) * here.sends);
      cut.round += down * (1 - link.up) * part;
      cut.gives_back = down * link.down * straight[ahead];
      part *= link.up * again;
    }
    arrived = link.up * here.sends * again;
    back = 1 - link.down + link.up * link.down * here.returns * again;
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
      const exact sent = behind[2 * other] + (closed ? share[other] * round : 0), gives = behind[2 * other + 1];
      const exact up = (sent + gives * link.down * down) / (1 - gives * (1 - link.up));
      up_arrives = link.up * up + (1 - link.down) * down;
      const exact lower = link.down * down + (1 - link.up) * up;
      sum[voxel] += up_arrives + comes;
      if (writes)
      {
        const ulong at = (ulong)(place.at[2] + 1) * lattice.layer + (ulong)(place.at[1] + 1) * lattice.row +
          place.at[0] + LatticeFirst;
        densities[i * lattice.stride + at] = straight[voxel] * up_arrives + source;
        densities[(i + 1) * lattice.stride + at] = down;
      }
      comes = lower;
      place = below;
      voxel = other;
    }
    else
    {
      up_arrives = closed ? closing.up * round + (1 - closing.down) * down : low.in + low.back * down;
      sum[voxel] += up_arrives + comes;
      if (writes)
      {
        const ulong at = (ulong)(first.at[2] + 1) * lattice.layer + (ulong)(first.at[1] + 1) * lattice.row +
          first.at[0] + LatticeFirst;
        densities[i * lattice.stride + at] = straight[voxel] * up_arrives + source;
        densities[(i + 1) * lattice.stride + at] = down;
      }
    }
  }
}
