// Solve along one line of links (numerics.md, Eqs. (L7) to (L10)), for LatticeLines.cl and CutLines.cl. The host
// defines what LatticeLink.cl and Numerics/Exact.cl require.
#pragma once
#include "LatticeBoltzmann/LatticeLink.cl"
#include "Numerics/Exact.cl"

// In single precision the weights add up to 1 only to 1e-8, and thick voxels would gain or lose that much in every
// collision.
#define EXACT_WEIGHT(i) (DIRECTIONS == 6 ? (exact)1 / 6 : (i) < 6 ? (exact)1 / 12 : (exact)1 / 24)

// Arrays by voxel: fraction of the density that continues straight, fraction that links transmit, n^2, and light that
// collisions redistribute isotropically, W / length^2.
#define MEDIUM                                                                                 \
  const __global exact *straight, const __global float *passes, const __global float *squared, \
    const __global exact *even

typedef struct
{
  int at[3];
  int face;  // of the grid that was passed, -1: none. Then `at` is the last voxel; OtherBlock: the line goes on there
  int other; // of a corner the second one, else the same
} Place;

// Fractions of light that a link transmits up the line and down it.
typedef struct
{
  exact up, down;
} Link;

static ulong voxel_at(LatticeInfo lattice, const int* at)
{
  return ((ulong)at[2] * lattice.size[1] + at[1]) * lattice.size[0] + at[0];
}

static bool is_endless(const __global float* endless, ulong voxel, int pair)
{
  return ENDLESS && ((int)endless[voxel] >> pair & 1);
}

static Place next_along(LatticeInfo lattice, Place place, int i)
{
  Place next = place;
  bool leaves_block = false;
  for (int a = 0; a < 3; ++a)
  {
    const int size = lattice.size[a], to = place.at[a] + Ways[i][a], face = 2 * a + (to < 0 ? 0 : 1);
    const bool beyond = to < 0 || to >= size, inner = lattice.inner >> face & 1, periodic = lattice.periodic >> a & 1;
    leaves_block = leaves_block || (beyond && inner);
    next.other = beyond && !inner && !periodic ? face : next.other;
    next.face = next.face < 0 ? next.other : next.face;
    next.at[a] = beyond ? (to + size) % size : to;
  }
  next.face = next.face < 0 && leaves_block ? OtherBlock : next.face;
  if (next.face >= 0)
  {
    for (int a = 0; a < 3; ++a)
    {
      next.at[a] = place.at[a];
    }
  }
  return next;
}

// The link between two voxels, from the fraction that links of each transmit (passes) and n^2 of each (squared).
static Link link_of(exact passes_a, exact passes_b, exact squared_a, exact squared_b)
{
  const exact own = 1 / passes_a, other = 1 / passes_b;
  const exact by_a = BENDS ? 1 / squared_a : 1, by_b = BENDS ? 1 / squared_b : 1;
  const exact both = 2 / (own * by_a + other * by_b + fabs(by_a - by_b));
  const Link link = { fmin(both * by_a, (exact)1), fmin(both * by_b, (exact)1) };
  return link;
}

static Link link_between(MEDIUM, ulong a, ulong b)
{
  return link_of(passes[a], passes[b], BENDS ? squared[a] : 1, BENDS ? squared[b] : 1);
}

// A face of the grid, or the mean of two at an edge: incident light, and the fraction of outgoing light that it
// reflects.
typedef struct
{
  exact in, back;
} Border;

static Border border_at(LatticeInfo lattice, MEDIUM, ulong voxel, Place past, exact incident, int i)
{
  const exact incoming = 0.5f * (lattice.incoming[past.face] + lattice.incoming[past.other]);
  const exact albedo = 0.5f * (lattice.albedo[past.face] + lattice.albedo[past.other]);
  const exact passing = 2 / (1 / (exact)passes[voxel] + 1);
  const Border border = { passing * incident * EXACT_WEIGHT(i) * incoming * (BENDS ? squared[voxel] : 1.0f),
    1 - passing * (1 - albedo) };
  return border;
}

// Finds where the work-item's line begins, and whether there is one. Lines along an axis are numbered by the two other
// coordinates; diagonal lines by the coordinate along the third axis and an index along the first rows of the plane.
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

// U and R of a voxel, found in the upward pass.
typedef struct
{
  exact sends, returns;
} Behind;

// Updates U and R across one voxel: light that arrives from behind is arrived + back * (what the voxel sends down).
static Behind pass_voxel(exact straight, exact source, exact arrived, exact back)
{
  const Behind behind = { straight * (arrived + back * source) + source, straight * straight * back };
  return behind;
}

// Light incident on the next voxel up: what arrives there, and the fraction of what it sends down that returns.
static Behind cross_up(Link link, Behind here)
{
  const exact again = 1 / (1 - here.returns * (1 - link.up));
  const Behind next = { link.up * here.sends * again, 1 - link.down + link.up * link.down * here.returns * again };
  return next;
}

// Light at a link for known light sent down it: what arrives above and below the link, and what is sent up.
typedef struct
{
  exact up_arrives, lower, up;
} Crossed;

// @param below  U and R of the voxel below: what it sends up, and the fraction of incident light that it returns
static Crossed cross_down(Link link, Behind below, exact down)
{
  const exact up = (below.sends + below.returns * link.down * down) / (1 - below.returns * (1 - link.up));
  const Crossed crossed = { link.up * up + (1 - link.down) * down, link.down * down + (1 - link.up) * up, up };
  return crossed;
}

// Beginning of a line or piece: light that arrives in its first voxel from behind, the fraction of what that voxel
// sends down that returns, and, if it is cut there, the fraction transmitted of what is sent up the cut.
typedef struct
{
  exact arrived, back, part;
} Beginning;

// Beginnings at a face of the grid, and at a cut, where the light sent up is not known yet.
static Beginning begin_at_border(Border low)
{
  const Beginning begin = { low.in, low.back, 0 };
  return begin;
}
static Beginning begin_at_cut(Link link)
{
  const Beginning begin = { 0, 1 - link.down, link.up };
  return begin;
}

// Light sent down to the cut of a line, if x is sent up there and B is sent down to the last voxel:
// sent + round x + gives_back B.
typedef struct
{
  exact sent, round, gives_back;
} Cut;

// The last voxel of a line, and its response to light sent up the cut.
typedef struct
{
  Place place;
  ulong voxel;
  int voxels;
  exact part;
  Cut cut;
} Top;

// The upward pass.
//   is_cut  true: the line is cut behind the first voxel
//   behind  [voxel][2], U and R
//   share   [voxel], if the line is cut: T, the voxel's response to light sent up the cut
static Top go_up(LatticeInfo lattice, MEDIUM, Place place, int i, Beginning begin, bool is_cut, __global exact* behind,
  __global exact* share)
{
  const exact weight = EXACT_WEIGHT(i);
  const ulong first_voxel = voxel_at(lattice, place.at);
  Top top = { place, first_voxel, 1, begin.part, { weight * even[first_voxel], 0, straight[first_voxel] } };
  exact arrived = begin.arrived, back = begin.back;
  for (;;)
  {
    const Behind here = pass_voxel(straight[top.voxel], weight * even[top.voxel], arrived, back);
    behind[2 * top.voxel] = here.sends;
    behind[2 * top.voxel + 1] = here.returns;
    if (is_cut)
    {
      top.part *= straight[top.voxel];
      share[top.voxel] = top.part;
    }
    const Place next = next_along(lattice, top.place, i);
    const ulong ahead = voxel_at(lattice, next.at);
    if (next.face >= 0 || ahead == first_voxel)
    {
      return top;
    }
    const Link link = link_between(straight, passes, squared, even, top.voxel, ahead);
    if (is_cut)
    {
      const exact again = 1 / (1 - here.returns * (1 - link.up));
      const exact down = top.cut.gives_back * again;
      top.cut.sent += down * (link.down * weight * even[ahead] + (1 - link.up) * here.sends);
      top.cut.round += down * (1 - link.up) * top.part;
      top.cut.gives_back = down * link.down * straight[ahead];
      top.part *= link.up * again;
    }
    const Behind beyond = cross_up(link, here);
    arrived = beyond.sends;
    back = beyond.returns;
    top.place = next;
    top.voxel = ahead;
    ++top.voxels;
  }
}

// Index of a voxel in the densities of one direction, in the layout of step_lattice.
static ulong density_at(LatticeInfo lattice, const int* at)
{
  return (ulong)(at[2] + 1) * lattice.layer + (ulong)(at[1] + 1) * lattice.row + at[0] + LatticeFirst;
}

// The downward pass.
//   comes     light sent down to the last voxel
//   round     light sent up the cut, if the line is cut; else 0
//   first     light that arrives in the first voxel from before it, and the fraction of what it sends down that returns
//   sum       [voxel], W / length^2: arriving light is added
//   writes    1: also write densities, in the layout of step_lattice
static void go_down(LatticeInfo lattice, MEDIUM, Top top, int i, exact comes, exact round, Border first, bool is_cut,
  const __global exact* behind, const __global exact* share, __global exact* sum, __global float* densities, int writes)
{
  const exact weight = EXACT_WEIGHT(i);
  for (; top.voxels > 0; --top.voxels)
  {
    const exact source = weight * even[top.voxel], down = straight[top.voxel] * comes + source;
    Place below = top.place;
    ulong other = top.voxel;
    Crossed crossed = { first.in + first.back * down, 0, 0 };
    if (top.voxels > 1)
    {
      below = next_along(lattice, top.place, i + 1);
      other = voxel_at(lattice, below.at);
      const Link link = link_between(straight, passes, squared, even, other, top.voxel);
      const Behind of_other = { behind[2 * other] + (is_cut ? share[other] * round : 0), behind[2 * other + 1] };
      crossed = cross_down(link, of_other, down);
    }
    sum[top.voxel] += crossed.up_arrives + comes;
    if (writes)
    {
      const ulong at = density_at(lattice, top.place.at);
      densities[i * lattice.stride + at] = straight[top.voxel] * crossed.up_arrives + source;
      densities[(i + 1) * lattice.stride + at] = down;
    }
    comes = crossed.lower;
    top.place = below;
    top.voxel = other;
  }
}
