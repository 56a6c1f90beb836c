// Streaming of light along lines of links, for given light that collisions emit isotropically (numerics.md, Eqs. (L7)
// to (L10)). The host defines the options of LatticeLink.cl and Numerics/Exact.cl.
//
// Light moves up and down a line, because links reflect a fraction of it. The voxels of a line up to a given voxel are
// described by two numbers: U, the light that they send up if none arrives from above, and R, the fraction of light
// arriving from above that they send back up. The upward pass computes U and R of every voxel, the downward pass the
// densities. All terms are positive, so that there is no cancellation.
#include "LatticeBoltzmann/LatticeLink.cl"
#include "Numerics/Exact.cl"

// Weight of direction i in double precision: single-precision weights add up to 1 only to 1e-8, and thick voxels would
// gain or lose that fraction in every collision.
#define EXACT_WEIGHT(i) (DIRECTIONS == 6 ? (exact)1 / 6 : (i) < 6 ? (exact)1 / 12 : (exact)1 / 24)

// Arrays by voxel that all functions read:
//   straight  fraction of the density that continues straight (a of Eq. (L7))
//   passes    fraction of light that a link between two voxels like this one transmits
//   squared   n^2
//   even      light that collisions and sources emit isotropically, W / length^2 (e of Eq. (L7))
#define MEDIUM                                                                                 \
  const __global exact *straight, const __global float *passes, const __global float *squared, \
    const __global exact *even

typedef struct
{
  int at[3];
  // Face of the grid beyond voxel `at`, where the line ends; OtherBlock: it continues in another block; -1: neither.
  int face;
  int other; // second face at an edge of the grid, else equal to `face`
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

// Link between two voxels a and b (numerics.md, Eq. (L5)), from their values of `passes` and `squared`.
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

// Boundary condition of a line at a face of the grid, or the mean of two faces at an edge: incident light, W /
// length^2, and the fraction of outgoing light that is reflected.
typedef struct
{
  exact in, back;
} Border;

static Border border_at(LatticeInfo lattice, MEDIUM, ulong voxel, Place past, int i)
{
  const exact incoming = 0.5f * (lattice.incoming[past.face] + lattice.incoming[past.other]);
  const exact albedo = 0.5f * (lattice.albedo[past.face] + lattice.albedo[past.other]);
  const exact passing = 2 / (1 / (exact)passes[voxel] + 1);
  const Border border = { passing * EXACT_WEIGHT(i) * incoming * (BENDS ? squared[voxel] : 1.0f),
    1 - passing * (1 - albedo) };
  return border;
}

// Finds the first voxel of the work-item's line in direction i, and whether the line is closed. @return whether the
// work-item has a line. Lines along an axis are numbered by the two other coordinates; diagonal lines by the coordinate
// along the third axis and an index along the two edges of the plane at which lines begin.
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

// Light that a voxel sends up, including the light of all voxels below it. sends: U, the light sent up if none arrives
// from above. returns: R, the fraction of light arriving from above that is sent up again.
typedef struct
{
  exact sends, returns;
} Behind;

// Computes U (sends) and R (returns) of a voxel (see Behind). The light that arrives in it from below is arrived + back
// * (light that the voxel sends down).
static Behind pass_voxel(exact straight, exact source, exact arrived, exact back)
{
  const Behind behind = { straight * (arrived + back * source) + source, straight * straight * back };
  return behind;
}

// Crosses the link to the next voxel up: returns the light that arrives in that voxel from below (V of Eq. (L10)), and
// the fraction of the light sent down by that voxel that returns to it (Q).
static Behind cross_up(Link link, Behind here)
{
  const exact again = 1 / (1 - here.returns * (1 - link.up));
  const Behind next = { link.up * here.sends * again, 1 - link.down + link.up * link.down * here.returns * again };
  return next;
}

// Light at a link: `up_arrives` arrives in the voxel above the link, `lower` arrives in the voxel below it, and `up` is
// the light that the voxel below sends up.
typedef struct
{
  exact up_arrives, lower, up;
} Crossed;

// Computes the light at a link from `down`, the light that the voxel above sends down, and `below`: the light that the
// voxel below sends up if none arrives from above, and the fraction of light arriving from above that it sends back up.
static Crossed cross_down(Link link, Behind below, exact down)
{
  const exact up = (below.sends + below.returns * link.down * down) / (1 - below.returns * (1 - link.up));
  const Crossed crossed = { link.up * up + (1 - link.down) * down, link.down * down + (1 - link.up) * up, up };
  return crossed;
}

// Lower end of a line, or of the piece of a line in one block. arrived: light that arrives in the first voxel from
// below. back: fraction of the light sent down by the first voxel that returns to it. part: fraction of the light sent
// up across the cut that the link transmits, if the line is cut at this end because it closes on itself around periodic
// axes or comes from another block; else 0.
typedef struct
{
  exact arrived, back, part;
} Beginning;

// Lower ends at a face of the grid, and at a cut (below the first voxel of a closed line, or towards another block),
// where the light sent up is unknown during the upward pass.
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

// A closed line is cut below its first voxel, and so is a line that comes from another block. Cut is the light that the
// first voxel sends down to the cut, as a linear function of the light x sent up across the cut and of the light B that
// arrives from above at the last voxel: sent + round x + gives_back B.
typedef struct
{
  exact sent, round, gives_back;
} Cut;

// State of the upward pass at the last voxel that it has reached: place and index of this voxel, and number of voxels
// so far. If the line is cut below its first voxel, light that is sent up across the cut arrives here in part: `part`
// is the fraction of it that this voxel sends on. `cut` is the light that the first voxel sends down to the cut.
typedef struct
{
  Place place;
  ulong voxel;
  int voxels;
  exact part;
  Cut cut;
} Top;

// Upward pass of one line, or of the piece of a line in one block, in direction i.
//   is_cut  true: the line is cut below its first voxel
//   behind  [voxel][2]: U, light that the voxel sends up if none arrives from above; R, fraction of light from above
//           that it sends back up
//   share   [voxel], if the line is cut: T, the fraction of light sent up across the cut that the voxel sends up
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

// Index of a voxel in the densities of one direction, which include a halo (LatticeInfo).
static ulong density_at(LatticeInfo lattice, const int* at)
{
  return (ulong)(at[2] + 1) * lattice.layer + (ulong)(at[1] + 1) * lattice.row + at[0] + LatticeFirst;
}

// Downward pass of one line, or of the piece of a line in one block, after go_up().
//   comes     light that arrives from above at the last voxel
//   round     light sent up across the cut, if the line is cut below its first voxel; else 0
//   first     light that arrives in the first voxel from below, and the fraction of the light it sends down that
//             returns
//   sum       [voxel], W / length^2; the light that arrives in the voxel from above and from below is added to it
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

// Solves all lines of the directions 2 pair and 2 pair + 1. One work-item per line.
//   behind    [voxel][2], scratch: U and R of go_up()
//   share     [voxel], scratch: in closed lines, the fraction of light sent up across the cut that the voxel sends up
//   sum       [voxel], W / length^2; the light that arrives in the voxel from above and from below is added to it
//   endless   [voxel], with ENDLESS: bit mask of the direction pairs whose line is endless; such lines carry no light
__kernel void sweep_lines(LinePass pass, MEDIUM, __global exact* behind, __global exact* share, __global exact* sum,
  __global float* densities, const __global float* endless)
{
  const LatticeInfo lattice = pass.lattice;
  const int pair = pass.pair;
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
    low = border_at(lattice, straight, passes, squared, even, voxel, before, i);
  }
  const Beginning begin = closed ? begin_at_cut(closing) : begin_at_border(low);
  const Top top = go_up(lattice, straight, passes, squared, even, place, i, begin, closed, behind, share);

  // Light that arrives from above at the last voxel (comes), and light that wraps around a closed line (round).
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
    const Border high = border_at(lattice, straight, passes, squared, even, top.voxel, past, i);
    const exact rest = 1 - high.back * returns;
    comes = rest > 0 ? (high.in + high.back * sends) / rest : 0;
  }
  go_down(lattice, straight, passes, squared, even, top, i, comes, round, low, closed, behind, share, sum, densities,
    pass.writes);
}

// Kernels for pieces of lines of links (PiecesOfLines.h): segments of a line in a rank's block, whose other pieces lie
// in other blocks, or across a periodic axis in this one. The upward pass computes the response of a piece to light at
// its ends, and the light it sends without such light. After the host has joined all pieces of a line, the downward
// pass computes the densities.

#define PIECE (get_global_id(1) * get_global_size(0) + get_global_id(0))

typedef struct
{
  Place place; // first voxel of the piece
  bool is_cut; // whether another piece precedes this piece
  Link link;   // link to the preceding piece; not used if no piece precedes
  Border low;  // boundary condition at the grid's face, if the piece begins there
} Piece;

// Finds the first voxel and the lower end of the work-item's piece, the segment of a line of links in this block.
//   below    [piece][2], of the voxel before the piece: `passes` (link transmission) and `squared` (n^2)
//   endless  [voxel], with ENDLESS: bit mask of the direction pairs whose line is endless
// @return false: no piece begins here, or its line is endless
static bool begin_piece(
  LatticeInfo lattice, MEDIUM, int pair, const __global exact* below, const __global float* endless, Piece* piece)
{
  const int i = 2 * pair;
  bool closed;
  if (!begin_line(lattice, i, &piece->place, &closed))
  {
    return false;
  }
  const Place before = next_along(lattice, piece->place, i + 1);
  const ulong voxel = voxel_at(lattice, piece->place.at);
  if (is_endless(endless, voxel, pair))
  {
    return false;
  }
  piece->is_cut = before.face == OtherBlock;
  piece->link.up = piece->link.down = piece->low.in = piece->low.back = 0;
  if (piece->is_cut)
  {
    const exact own = BENDS ? squared[voxel] : 1, other = BENDS ? below[2 * PIECE + 1] : 1;
    piece->link = link_of(below[2 * PIECE], passes[voxel], other, own);
  }
  else
  {
    piece->low = border_at(lattice, straight, passes, squared, even, voxel, before, i);
  }
  return true;
}

// Last voxel of the piece with the first voxel `place`, and the piece's number of voxels.
static Top last_of_piece(LatticeInfo lattice, Place place, int i)
{
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
  const Top top = { place, voxel_at(lattice, place.at), ways + 1, 0, { 0, 0, 0 } };
  return top;
}

// Upward pass of the pieces along a pair of directions. One work-item per piece; arrays as in sweep_lines, and
//   sent  [piece][8], s[0] to s[7], for light x sent up across the cut before the piece and light B arriving from above
//         at its last voxel (PieceOfLine): the last voxel sends up s[0] + s[2] x + s[3] B, the first voxel sends down
//         s[1] + s[4] x + s[5] B; the link before the piece transmits the fractions s[6] upwards and s[7] downwards
__kernel void pieces_up(LinePass pass, MEDIUM, const __global exact* below, const __global float* endless,
  __global exact* behind, __global exact* share, __global exact* sent)
{
  const LatticeInfo lattice = pass.lattice;
  const int pair = pass.pair;
  Piece piece;
  if (!begin_piece(lattice, straight, passes, squared, even, pair, below, endless, &piece))
  {
    for (int k = 0; k < 8; ++k)
    {
      sent[8 * PIECE + k] = 0;
    }
    return;
  }
  const int i = 2 * pair;
  const Beginning begin = piece.is_cut ? begin_at_cut(piece.link) : begin_at_border(piece.low);
  Top top = go_up(lattice, straight, passes, squared, even, piece.place, i, begin, piece.is_cut, behind, share);
  const exact sends = behind[2 * top.voxel], returns = behind[2 * top.voxel + 1];
  const Place past = next_along(lattice, top.place, i);
  if (past.face != OtherBlock)
  {
    const Border high = border_at(lattice, straight, passes, squared, even, top.voxel, past, i);
    const exact rest = 1 - high.back * returns;
    const exact again = rest > 0 ? top.cut.gives_back / rest : 0;
    top.cut.sent += again * (high.in + high.back * sends);
    top.cut.round += again * high.back * top.part;
    top.cut.gives_back = 0;
  }
  __global exact* of = sent + 8 * PIECE;
  of[0] = sends;
  of[1] = top.cut.sent;
  of[2] = top.part;
  of[3] = returns;
  of[4] = top.cut.round;
  of[5] = top.cut.gives_back;
  of[6] = piece.link.up;
  of[7] = piece.link.down;
}

// Downward pass of the pieces along a pair of directions, after pieces_up. One work-item per piece; arrays as in
// sweep_lines, and
//   joined     [piece][3]: light sent up across the cut before the piece, light arriving from above at its last voxel,
//              and light that the first voxel of the next piece sends down
//   densities  if pass.writes, also the densities that the voxels before and after the piece send into it
__kernel void pieces_down(LinePass pass, MEDIUM, const __global exact* below, const __global float* endless,
  const __global exact* behind, const __global exact* share, const __global exact* joined, __global exact* sum,
  __global float* densities)
{
  const LatticeInfo lattice = pass.lattice;
  const int pair = pass.pair;
  Piece piece;
  if (!begin_piece(lattice, straight, passes, squared, even, pair, below, endless, &piece))
  {
    return;
  }
  const int i = 2 * pair;
  const ulong first_at = density_at(lattice, piece.place.at);
  const Top top = last_of_piece(lattice, piece.place, i);
  const ulong last_at = density_at(lattice, top.place.at);
  const __global exact* of = joined + 3 * PIECE;
  const exact round = piece.is_cut ? of[0] : 0;
  exact comes = of[1];
  const Place past = next_along(lattice, top.place, i);
  if (past.face != OtherBlock)
  {
    const Border high = border_at(lattice, straight, passes, squared, even, top.voxel, past, i);
    const exact sends = behind[2 * top.voxel] + (piece.is_cut ? share[top.voxel] * round : 0);
    const exact rest = 1 - high.back * behind[2 * top.voxel + 1];
    comes = rest > 0 ? (high.in + high.back * sends) / rest : 0;
  }
  else if (pass.writes)
  {
    densities[(i + 1) * lattice.stride + last_at + lattice.offset[i]] = of[2];
  }
  if (piece.is_cut)
  {
    piece.low.in = piece.link.up * round;
    piece.low.back = 1 - piece.link.down;
    if (pass.writes)
    {
      densities[i * lattice.stride + first_at - lattice.offset[i]] = round;
    }
  }
  go_down(lattice, straight, passes, squared, even, top, i, comes, round, piece.low, piece.is_cut, behind, share, sum,
    densities, pass.writes);
}
