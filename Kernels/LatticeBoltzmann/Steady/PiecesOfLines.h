#pragma once

#include "Distribution/BlockPartition.h"

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace tyndall
{
/// Two-dimensional range of work-items that trace the lines of a pair of directions through a box; some items have no
/// line.
std::array<std::size_t, 2> LinesOfPair(const std::array<int, 3>& size, int pair);

/// Lines of links along one pair of directions through a decomposed grid, each a sequence of pieces: a piece is the
/// segment of a line in one block. Pieces of a block are numbered by the work-items of LatticeLines.cl. With periodic
/// axes a line may pass through a block several times, and may be closed.
class PiecesOfLines
{
public:
  /// A piece, identified by the rank of its block and its number in that block.
  struct Piece
  {
    int rank = 0;
    std::size_t number = 0;
  };
  struct Line
  {
    /// in upward order, i.e. in the order in which light along direction 2 pair crosses them
    std::vector<Piece> pieces;
    bool closed = false;
  };

  /// @param partition  must outlive this
  PiecesOfLines(const BlockPartition& partition, const std::array<bool, 3>& periodic, int pair);

  /// Calls visit(rank, line) for each line of links that is closed or has several pieces, i.e. crosses faces of blocks.
  /// The line begins in the block of `rank`. The order is the same on all ranks.
  void ForLines(const std::function<void(int rank, const Line& line)>& visit) const;

  /// Two-dimensional range of work-items, one for each possible piece of a line in a rank's block.
  std::array<std::size_t, 2> Range(int rank) const;
  /// Calls visit(piece number, its first voxel in the whole grid) for each piece of a line in a rank's block.
  template <class Visit>
  void ForPieces(int rank, const Visit& visit) const;

private:
  using Voxel = std::array<int, 3>;
  /// Index along `axis` of the plane of voxels at which lines enter a box. The lines' direction has a component along
  /// `axis`.
  int Entry(const VoxelBox& box, int axis) const
  {
    return this->Way[axis] > 0 ? box.first[axis] : EndOf(box, axis) - 1;
  }
  int RankAt(const Voxel& voxel) const;
  Piece PieceAt(int rank, const Voxel& first) const;
  bool MoveOn(int rank, Voxel& voxel) const;
  Line Follow(const Voxel& first, bool closed) const;
  std::vector<Voxel> FirstVoxels(const VoxelBox& box, const std::array<bool, 3>& periodic) const;
  bool Closes() const;

  const BlockPartition& Partition;
  std::array<bool, 3> Periodic;
  int Pair;
  std::array<int, 3> Way;
  std::vector<int> Moving, Still; ///< axes along which the link vector has a component, and along which it has none
};

template <class Visit>
void PiecesOfLines::ForPieces(int rank, const Visit& visit) const
{
  for (const Voxel& first : this->FirstVoxels(this->Partition.blocks[rank], {}))
  {
    visit(this->PieceAt(rank, first).number, first);
  }
}

/// Linear response of a piece of a line of links to light at its ends (numerics.md, Eq. (L15)): x is sent up by the
/// voxel before the first voxel of the piece, B arrives from above at the last voxel. The response depends only on the
/// medium.
struct PieceOfLine
{
  double passes = 0.0;    ///< fraction of the light x from below that the last voxel sends up
  double returns = 0.0;   ///< fraction of the light B from above that the last voxel sends up
  double givesBack = 0.0; ///< fraction of the light x from below that the first voxel sends down
  /// Fraction of the light B from above that the first voxel sends down; 0: the piece ends at a face of the grid.
  double comesDown = 0.0;
  double up = 0.0;   ///< fraction of light that the link before the piece transmits upwards
  double down = 0.0; ///< fraction of light that the link before the piece transmits downwards
};

/// Light that a piece of a line sends from its own sources, if no light arrives at its ends, W / length^2.
struct SentByPiece
{
  double up = 0.0;   ///< light that the last voxel sends up
  double down = 0.0; ///< light that the first voxel sends down
};

/// Light at the ends of a piece, W / length^2: `up` and `down` are x and B of PieceOfLine; `sentBeyond` is sent down by
/// the first voxel of the next piece.
struct ComesToPiece
{
  double up = 0.0, down = 0.0, sentBeyond = 0.0;
};

/// Solves for the light at the ends of all pieces of a line (numerics.md, Eqs. (L10) and (L15)). All terms are
/// positive, so that there is no cancellation.
/// @param pieces, sent  in upward order
/// @param closed  whether the line returns from its last piece to the first one
std::vector<ComesToPiece> JoinLine(
  const std::vector<PieceOfLine>& pieces, const std::vector<SentByPiece>& sent, bool closed);
}
