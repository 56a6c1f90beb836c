#pragma once

#include <vector>

namespace tyndall
{
/// Response of a piece of a line of links to light at its ends, numerics.md, Eq. (L15): x, sent up by the voxel before
/// it, and B, sent down to its last voxel. It depends on the medium alone.
struct PieceOfLine
{
  double passes = 0.0;    ///< of x, what its last voxel sends up
  double returns = 0.0;   ///< the same of B
  double givesBack = 0.0; ///< of x, what its first voxel sends down
  double comesDown = 0.0; ///< the same of B; 0: it ends at a face of the grid
  double up = 0.0;        ///< parts that the link before it lets up and down
  double down = 0.0;
};

/// What a piece sends without light at its ends, W / length^2.
struct SentByPiece
{
  double up = 0.0;   ///< by its last voxel
  double down = 0.0; ///< by its first
};

/// Light at the ends of a piece, and what the first voxel of the next piece sends down.
struct ComesToPiece
{
  double up = 0.0, down = 0.0, sentBeyond = 0.0;
};

/// Solves a line from its pieces, in their order up the line, as sweep_lines solves one from its voxels (numerics.md,
/// Eqs. (L10) and (L15)). All terms are positive.
/// @param closed  the last piece continues in the first
std::vector<ComesToPiece> JoinLine(
  const std::vector<PieceOfLine>& pieces, const std::vector<SentByPiece>& sent, bool closed);
}
