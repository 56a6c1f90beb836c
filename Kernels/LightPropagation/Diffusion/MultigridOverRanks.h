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
/// The system of MultigridSolver.h on a grid that is spread over ranks by blocks: conjugate gradients with sums over
/// all ranks, preconditioned by the same cycle of multigrid, in double on the host. Cells of coarser levels are those
/// of the whole grid, whatever the blocks: the rank that has a cell's first voxel owns it, others add what they have of
/// it. Where few are left the first rank has them all. What it finds therefore does not depend on the blocks, but for
/// rounding (numerics.md, section 7.14).
///
/// All ranks make one and call it together.
class MultigridOverRanks
{
public:
  /// @param communicator  must stay
  /// @param gatherAtMost  cells of a level that the first rank has alone; of the finest none is gathered
  MultigridOverRanks(Communicator& communicator, const BlockPartition& partition,
    const std::array<bool, 3>& periodic = {}, std::size_t gatherAtMost = FewCells);

  /// As BlockWithGhosts: the rank's block and the layer of voxels beside it, what arrays are over, x fastest. Of none
  /// where the block is.
  const VoxelBox& Held() const { return this->Levels.front().held; }

  /// @param conductance  by axis, of low faces of the block's voxels and of those above it; 0 at the end of an axis
  ///   that is not periodic
  /// @param loss  of the block's voxels
  void SetMatrix(const std::array<std::vector<float>, 3>& conductance, const std::vector<float>& loss);

  /// As MultigridSolver::Solve, of the residual of all ranks.
  /// @param values  of the block the first guess; the solution, and that of the voxels beside it
  /// @return iterations
  int Solve(std::vector<double>& values, const std::vector<float>& right, double unit, double reduction,
    double leftAtMost = std::numeric_limits<double>::infinity());
  /// The same of what the last Solve left.
  int GoOn(std::vector<double>& values, double unit, double reduction, double leftAtMost);

private:
  static constexpr std::size_t FewCells = 32768;
  struct Level
  {
    std::array<int, 3> size = {};   ///< of the whole
    std::array<int, 3> halved = {}; ///< to the next coarser level
    std::array<bool, 3> periodic = {};
    std::array<bool, 3> alone = {};             ///< axes round which this rank's own cells go on with themselves
    VoxelBox own, held;                         ///< of this rank
    std::unique_ptr<GhostCells> beside, shared; ///< cells beside own ones; others' that have finer cells of this rank
    std::array<std::vector<double>, 3> conductance;
    /// As MultigridSolver has them, over `held`.
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
  std::vector<double> Direction, Applied; ///< over the finest level's box
  double FirstResidual = 0.0;
};
}
