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

/// Lines of links along one pair of directions through a distributed grid. Each block holds pieces of the lines,
/// numbered by the work-items of LatticeLines.cl. With periodic axes a line may pass through a block several times, and
/// be closed.
class PiecesOfLines
{
public:
  /// A piece: the rank of its block and its number there.
  struct Piece
  {
    int rank = 0;
    std::size_t number = 0;
  };
  struct Line
  {
    std::vector<Piece> pieces; ///< in upward order
    bool closed = false;
  };

  /// @param partition  must outlive this
  PiecesOfLines(const BlockPartition& partition, const std::array<bool, 3>& periodic, int pair);

  /// Calls visit(rank in whose block it begins, line) for each line with several pieces, or closed, in the same order
  /// on all ranks.
  void ForLines(const std::function<void(int rank, const Line& line)>& visit) const;

  std::array<std::size_t, 2> Range(int rank) const; ///< of work-items
  /// Calls visit(piece number, its first voxel in the whole grid) for each piece of a rank's block.
  template <class Visit>
  void ForPieces(int rank, const Visit& visit) const;

private:
  using Voxel = std::array<int, 3>;
  /// Coordinate at which lines enter a box, along an axis that they move along.
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
  std::vector<int> Moving, Still; ///< axes
};

template <class Visit>
void PiecesOfLines::ForPieces(int rank, const Visit& visit) const
{
  for (const Voxel& first : this->FirstVoxels(this->Partition.blocks[rank], {}))
  {
    visit(this->PieceAt(rank, first).number, first);
  }
}

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
