#pragma once

#include <vector>

namespace tyndall
{
/// Linear response of a piece of a line of links to light at its ends (numerics.md, Eq. (L15)): x, sent up by the voxel
/// before its first voxel, and B, sent down to its last voxel. It depends on the medium alone.
struct PieceOfLine
{
  double passes = 0.0;    ///< fraction of x that its last voxel sends up
  double returns = 0.0;   ///< fraction of B that its last voxel sends up
  double givesBack = 0.0; ///< fraction of x that its first voxel sends down
  double comesDown = 0.0; ///< fraction of B that its first voxel sends down; 0: the piece ends at a face of the grid
  double up = 0.0;        ///< fraction that the link before it transmits upwards
  double down = 0.0;      ///< fraction that it transmits downwards
};

/// Light that a piece sends without light incident at its ends, W / length^2.
struct SentByPiece
{
  double up = 0.0;   ///< sent by its last voxel
  double down = 0.0; ///< sent by its first voxel
};

/// Light incident at the ends of a piece, and light that the first voxel of the next piece sends down, W / length^2.
struct ComesToPiece
{
  double up = 0.0, down = 0.0, sentBeyond = 0.0;
};

/// Solves a line from its pieces, given in upward order, as sweep_lines solves one from its voxels (numerics.md, Eqs.
/// (L10) and (L15)). All terms are positive.
/// @param closed  whether the last piece continues in the first
std::vector<ComesToPiece> JoinLine(
  const std::vector<PieceOfLine>& pieces, const std::vector<SentByPiece>& sent, bool closed);
}
