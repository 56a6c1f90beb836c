#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Lights/Rgb.h"

#include <functional>
#include <memory>
#include <vector>

namespace tyndall
{
/// A distributed grid as one rank sees it: the rank's own block, the whole grid, and reductions over the ranks. On one
/// rank the block is the whole grid, a reduction returns its argument, and a collective step is a plain call. A solver
/// therefore need not know the number of ranks. A block may have no voxels.
class Domain
{
public:
  /// Creates the domain of a serial solve: the whole grid on one rank.
  explicit Domain(const Grid& grid);
  /// Creates the domain of a distributed solve: one block per rank.
  /// @param communicator  must outlive the domain
  Domain(Communicator& communicator, BlockPartition partition);

  /// This domain with the origin and the spacing of the grid `whole`.
  Domain WithGrid(const Grid& whole) const;
  /// A domain with another partition of the grid, on the ranks of this domain.
  Domain WithBlocks(BlockPartition partition) const;

  const Grid& Whole() const { return this->Blocks.whole; }
  const BlockPartition& Partition() const { return this->Blocks; }
  int Rank() const { return this->Ranks->Rank(); }
  /// Own: this rank's block, a box of voxels of the whole grid. OwnGrid: this block as a grid.
  const VoxelBox& Own() const { return this->Blocks.blocks[this->Rank()]; }
  Grid OwnGrid() const { return this->Blocks.OwnGrid(this->Rank()); }
  bool IsEmpty() const { return this->Own().VoxelCount() == 0; }
  bool IsSerial() const { return this->Ranks->Ranks() == 1; }
  Communicator& Comm() const { return *this->Ranks; }

  // The following functions are collective: all ranks call them with the same number of values.
  double Sum(double own) const;
  Rgb Sum(const Rgb& own) const;
  std::vector<double> Sum(const std::vector<double>& own) const { return this->Ranks->Sum(own); }
  double Max(double own) const;
  std::vector<double> Max(const std::vector<double>& own) const { return this->Ranks->Largest(own); }
  bool Any(bool own) const;
  /// Runs `step`; if it throws on one rank, all ranks throw the same error (Communicator::Collective).
  void Collective(const std::function<void()>& step) const { this->Ranks->Collective(step); }

private:
  std::shared_ptr<Communicator> Ranks;
  BlockPartition Blocks;
};
}
