// Lines of links through a rank's block: pieces of lines, of which others lie in other blocks, or in this one again
// where an axis is periodic. What a piece does to light, and what it sends by itself, is found on its way up; when all
// pieces of a line have been joined (JoinedLines.h), densities follow on its way down.
#include "LatticeBoltzmann/Steady/LatticeLine.cl"

#define PIECE (get_global_id(1) * get_global_size(0) + get_global_id(0))

typedef struct
{
  Place place; // the first voxel
  bool is_cut; // behind it lies another block
  Link link;   // to that
  Border low;  // or the grid's face
} Piece;

// below    [piece][2], of the voxel behind it: part that links let through, n^2
// endless  as of sweep_lines
// @return false: none begins here, or it is of a line that stays dark
static bool begin_piece(LatticeInfo lattice, MEDIUM, int pair, exact shines, const __global exact* below,
  const __global float* endless, Piece* piece)
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
    piece->low = border_at(lattice, straight, passes, squared, even, voxel, before, shines, i);
  }
  return true;
}

// The last voxel of a piece.
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

// Up the pieces of a pair of directions. A work-item a piece; arrays as of sweep_lines, and
//   says  [piece][8], of x that goes up the cut behind it and B that comes down to its last voxel (PieceOfLine): what
//         the last voxel sends up, 0 + 2 x + 3 B; what the first sends down, 1 + 4 x + 5 B; parts that the link behind
//         lets up and down
__kernel void pieces_up(LatticeInfo lattice, MEDIUM, int pair, exact shines, const __global exact* below,
  const __global float* endless, __global exact* behind, __global exact* share, __global exact* says)
{
  Piece piece;
  if (!begin_piece(lattice, straight, passes, squared, even, pair, shines, below, endless, &piece))
  {
    for (int k = 0; k < 8; ++k)
    {
      says[8 * PIECE + k] = 0;
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
    const Border high = border_at(lattice, straight, passes, squared, even, top.voxel, past, shines, i);
    const exact rest = 1 - high.back * returns;
    const exact again = rest > 0 ? top.cut.gives_back / rest : 0;
    top.cut.sent += again * (high.in + high.back * sends);
    top.cut.round += again * high.back * top.part;
    top.cut.gives_back = 0;
  }
  __global exact* of = says + 8 * PIECE;
  of[0] = sends;
  of[1] = top.cut.sent;
  of[2] = top.part;
  of[3] = returns;
  of[4] = top.cut.round;
  of[5] = top.cut.gives_back;
  of[6] = piece.link.up;
  of[7] = piece.link.down;
}

// Down them, after pieces_up.
//   joined  [piece][3]: x, B, and what the first voxel of the piece beyond sends down
//   densities  those of the voxels behind and beyond, too, on the way to these
__kernel void pieces_down(LatticeInfo lattice, MEDIUM, int pair, exact shines, const __global exact* below,
  const __global float* endless, const __global exact* behind, const __global exact* share,
  const __global exact* joined, __global exact* sum, __global float* densities, int writes)
{
  Piece piece;
  if (!begin_piece(lattice, straight, passes, squared, even, pair, shines, below, endless, &piece))
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
    const Border high = border_at(lattice, straight, passes, squared, even, top.voxel, past, shines, i);
    const exact sends = behind[2 * top.voxel] + (piece.is_cut ? share[top.voxel] * round : 0);
    const exact rest = 1 - high.back * behind[2 * top.voxel + 1];
    comes = rest > 0 ? (high.in + high.back * sends) / rest : 0;
  }
  else if (writes)
  {
    densities[(i + 1) * lattice.stride + last_at + lattice.offset[i]] = of[2];
  }
  if (piece.is_cut)
  {
    piece.low.in = piece.link.up * round;
    piece.low.back = 1 - piece.link.down;
    if (writes)
    {
      densities[i * lattice.stride + first_at - lattice.offset[i]] = round;
    }
  }
  go_down(lattice, straight, passes, squared, even, top, i, comes, round, piece.low, piece.is_cut, behind, share, sum,
    densities, writes);
}
