#pragma once

#include "Distribution/BlockPartition.h"

#include <array>
#include <cstddef>
#include <vector>

namespace tyndall
{
/// Lines of links of one pair of directions through a grid in blocks: each block has pieces of them, numbered as the
/// work-items of BlockLines.cl. Where axes are periodic a line may come through a block several times, and close.
class PiecesOfLines
{
public:
  /// A piece, by the block's rank and its number there.
  struct Piece
  {
    int rank = 0;
    std::size_t number = 0;
  };
  struct Line
  {
    std::vector<Piece> pieces; ///< on the way up
    bool closed = false;
  };

  /// @param partition  must stay
  PiecesOfLines(const BlockPartition& partition, const std::array<bool, 3>& periodic, int pair);

  /// Lines that begin in the block of a rank, or are cut there, but for those that no other piece belongs to.
  std::vector<Line> LinesFrom(int rank) const;

  std::array<std::size_t, 2> Range(int rank) const; ///< of work-items
  /// visit(piece, its first voxel in the whole grid) for each piece of a rank's block.
  template <class Visit>
  void ForPieces(int rank, const Visit& visit) const;

private:
  using Voxel = std::array<int, 3>;
  /// Along an axis that lines go along, where they come into a box.
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
