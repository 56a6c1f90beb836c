#pragma once

#include "Distribution/BlockPartition.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Two-dimensional range of work-items that trace the lines of a pair of directions through a box; some items have no
/// line.
std::array<std::size_t, 2> LinesOfPair(const std::array<int, 3>& size, int pair);

/// Lines of links along one pair of directions through a distributed grid. Each block holds pieces of the lines,
/// numbered by the work-items of CutLines.cl. With periodic axes a line may pass through a block several times, and be
/// closed.
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

  /// The lines with several pieces, or closed, that begin in a rank's block.
  std::vector<Line> LinesFrom(int rank) const;

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
}
