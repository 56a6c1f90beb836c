// Pieces of lines of links in a rank's block; the other pieces of a line lie in other blocks, or across a periodic axis
// in this one. The upward pass finds a piece's response to light at its ends, and what it sends without such light.
// When all pieces of a line have been joined (JoinedLine.h), the downward pass finds the densities.
#include "LatticeBoltzmann/Steady/LatticeLine.cl"

#define PIECE (get_global_id(1) * get_global_size(0) + get_global_id(0))

typedef struct
{
  Place place; // the first voxel
  bool is_cut; // another piece precedes it
  Link link;   // to that piece
  Border low;  // the grid's face, if no piece precedes it
} Piece;

// below    [piece][2], for the voxel before the piece: fraction that links transmit, n^2
// endless  as in sweep_lines
// @return false: no piece begins here, or its line is endless
static bool begin_piece(LatticeInfo lattice, MEDIUM, int pair, exact incident, const __global exact* below,
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
    piece->low = border_at(lattice, straight, passes, squared, even, voxel, before, incident, i);
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

// Upward pass of the pieces along a pair of directions. One work-item per piece; arrays as in sweep_lines, and
//   sent  [piece][8], for x sent up the cut before it and B sent down to its last voxel (PieceOfLine). With s[k] for
//         the eight values: the last voxel sends up s[0] + s[2] x + s[3] B, the first one sends down s[1] + s[4] x +
//         s[5] B; the link before the piece transmits the fractions s[6] upwards and s[7] downwards
__kernel void pieces_up(LatticeInfo lattice, MEDIUM, int pair, exact incident, const __global exact* below,
  const __global float* endless, __global exact* behind, __global exact* share, __global exact* sent)
{
  Piece piece;
  if (!begin_piece(lattice, straight, passes, squared, even, pair, incident, below, endless, &piece))
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
    const Border high = border_at(lattice, straight, passes, squared, even, top.voxel, past, incident, i);
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

// Downward pass of the pieces, after pieces_up.
//   joined  [piece][3]: x, B, and what the first voxel of the next piece sends down
//   densities  also those that the voxels before and after the piece send into it
__kernel void pieces_down(LatticeInfo lattice, MEDIUM, int pair, exact incident, const __global exact* below,
  const __global float* endless, const __global exact* behind, const __global exact* share,
  const __global exact* joined, __global exact* sum, __global float* densities, int writes)
{
  Piece piece;
  if (!begin_piece(lattice, straight, passes, squared, even, pair, incident, below, endless, &piece))
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
    const Border high = border_at(lattice, straight, passes, squared, even, top.voxel, past, incident, i);
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
