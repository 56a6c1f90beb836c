#pragma once

#include <vector>

namespace tyndall
{
/// What a piece of a line of links does to light that comes to its ends: x that the voxel behind it sends up, and B
/// that comes down to its last voxel. These parts depend on the medium alone (BlockLines.cl has them so).
struct PieceOfLine
{
  double passes = 0.0;    ///< of x, what its last voxel sends up
  double returns = 0.0;   ///< the same of B
  double givesBack = 0.0; ///< of x, what its first voxel sends down
  double comesDown = 0.0; ///< the same of B; 0: ahead of it is a face of the grid
  double up = 0.0;        ///< parts that the link behind it lets up and down
  double down = 0.0;
};

/// What it sends by itself, W / length^2.
struct SentByPiece
{
  double up = 0.0;   ///< by its last voxel
  double down = 0.0; ///< by its first
};

/// What comes to its ends, and what the first voxel of the next piece sends down.
struct ComesToPiece
{
  double up = 0.0, down = 0.0, sentBeyond = 0.0;
};

/// A line from its pieces, in the order of the way up, as sweep_lines solves one from its voxels (numerics.md, Eqs.
/// (L10) and (L15)): what lies behind is known by what it sends and gives back, all terms are positive.
/// @param closed  the last piece goes on into the first; else there is nothing behind that
std::vector<ComesToPiece> JoinLine(
  const std::vector<PieceOfLine>& pieces, const std::vector<SentByPiece>& sent, bool closed);
}
