#pragma once

#include "Distribution/BlockPartition.h"
#include "Distribution/Communicator.h"
#include "Distribution/GhostCells.h"

#include <array>
#include <limits>
#include <memory>
#include <vector>

namespace tyndall
{
/// The linear system of MultigridSolver.h on a grid distributed over ranks by blocks: conjugate gradients with sums
/// over all ranks, preconditioned by the same multigrid cycle, in double on the host. Cells of coarser levels are those
/// of the whole grid, independent of the blocks: the rank that owns a cell's first voxel owns the cell, and other ranks
/// send it their contributions. Levels with few cells are gathered on the first rank. The result therefore does not
/// depend on the partition, except for rounding (numerics.md, section 7.14).
///
/// Constructor and functions are collective.
class MultigridOverRanks
{
public:
  /// @param communicator  must outlive this object
  /// @param gatherAtMost  levels with at most this many cells are gathered on the first rank; never the finest
  MultigridOverRanks(Communicator& communicator, const BlockPartition& partition,
    const std::array<bool, 3>& periodic = {}, std::size_t gatherAtMost = FewCells);

  /// The rank's block and its halo of one voxel, see BlockWithGhosts: the box of the arrays, x fastest. Empty if the
  /// block is.
  const VoxelBox& Held() const { return this->Levels.front().held; }

  /// @param conductance  by axis, of the low faces of the block's voxels and of the voxels above the block; 0 at the
  ///   ends of an axis that is not periodic
  /// @param loss  of the block's voxels
  void SetMatrix(const std::array<std::vector<float>, 3>& conductance, const std::vector<float>& loss);

  /// As MultigridSolver::Solve(), with the residual of all ranks.
  /// @param values  initial guess for the block's voxels; replaced by the solution, also in the halo
  /// @return number of iterations
  int Solve(std::vector<double>& values, const std::vector<float>& right, double unit, double reduction,
    double leftAtMost = std::numeric_limits<double>::infinity());
  /// Continues the last Solve().
  int GoOn(std::vector<double>& values, double unit, double reduction, double leftAtMost);

private:
  static constexpr std::size_t FewCells = 32768;
  struct Level
  {
    std::array<int, 3> size = {};   ///< of the whole grid, cells
    std::array<int, 3> halved = {}; ///< 1: halved to the next coarser level
    std::array<bool, 3> periodic = {};
    std::array<bool, 3> alone = {}; ///< periodic axes on which this rank's own cells are their own neighbours
    VoxelBox own, held;             ///< cells that this rank owns, and these with their halo
    /// Exchange of the halo; exchange of other ranks' cells that contain finer cells of this rank.
    std::unique_ptr<GhostCells> beside, shared;
    std::array<std::vector<double>, 3> conductance;
    /// As in MultigridSolver, over `held`.
    std::vector<double> loss, inverse, right, guess, better, kept;

    std::size_t Stride(int axis) const
    {
      return axis == 0 ? 1 : static_cast<std::size_t>(this->held.size[0]) * (axis == 1 ? 1 : this->held.size[1]);
    }
  };
  struct Row;

  void AddLevel(const std::array<int, 3>& size, const std::array<int, 3>& halved, std::vector<VoxelBox> own,
    const std::vector<VoxelBox>& touched);
  template <class Act>
  static void ForRows(const Level& level, const Act& act);
  template <class Term>
  static double SumOverRows(const Level& level, const Term& term);
  static Row RowOf(const Level& level, int y, int z);
  static double Apply(const Level& level, const std::vector<double>& values, const Row& row, int x);
  static double Diagonal(const Level& level, const Row& row, int x);
  template <class Act>
  static void ForParents(const Level& fine, const Level& coarse, const Act& act);
  void CoarsenMatrix(const Level& fine, Level& coarse) const;
  void InvertDiagonal(Level& level) const;
  double SumOfAll(double own) const { return this->Comm.Sum({ own })[0]; }

  void Visit(std::size_t level);
  void VisitTwice(std::size_t level);
  void Restrict(Level& fine, Level& coarse) const;
  void Correct(Level& fine, Level& coarse) const;
  static void Finish(Level& level);
  double Precondition();
  double Begin(std::vector<double>& values, const std::vector<float>& right, double unit);
  double GoAlong(std::vector<double>& values, double length, double unit);
  int Iterate(std::vector<double>& values, double left, double unit, double reduction, double leftAtMost);

  Communicator& Comm;
  const std::array<bool, 3> Periodic;
  std::vector<Level> Levels;
  std::vector<double> Direction, Applied; ///< over the box of the finest level
  double FirstResidual = 0.0;
};
}
