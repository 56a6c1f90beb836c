// The multigrid solver on one rank and on several, whose result must not depend on the blocks.

#include "DeviceTest.h"

#include "Distribution/Halo.h"
#include "LightPropagation/Diffusion/MultigridSolver.h"
#include "RanksInThreads.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <random>
#include <string>
#include <vector>

using namespace tyndall;

namespace
{
constexpr std::array<bool, 3> None = { false, false, false };

/// A diffusion matrix by chance, and its product with values in double.
class RandomMatrix
{
public:
  /// @param contrast  of conductances and losses, at most
  /// @param loss  largest one
  RandomMatrix(const std::array<int, 3>& size, const std::array<bool, 3>& periodic, double contrast, float loss = 0.1f)
    : Size(size)
    , Count(static_cast<std::size_t>(size[0]) * size[1] * size[2])
    , Conductance(3 * this->Count)
  {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> power(-1.0, 0.0);
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      this->Loss.push_back(static_cast<float>(loss * std::pow(contrast, power(random))));
      for (int axis = 0; axis < 3; ++axis)
      {
        const bool passes = size[axis] > 1 && (periodic[axis] || this->At(i)[axis] > 0);
        this->Conductance[axis * this->Count + i] =
          passes ? static_cast<float>(std::pow(contrast, power(random))) : 0.0f;
      }
    }
  }

  std::vector<double> Times(const std::vector<double>& x) const
  {
    std::vector<double> product(this->Count);
    for (std::size_t i = 0; i < this->Count; ++i)
    {
      product[i] += this->Loss[i] * x[i];
      for (int axis = 0; axis < 3; ++axis)
      {
        const std::size_t j = this->Before(i, axis);
        const double flow = this->Conductance[axis * this->Count + i] * (x[i] - x[j]);
        product[i] += flow;
        product[j] -= flow;
      }
    }
    return product;
  }

  const std::vector<float>& Losses() const { return this->Loss; }
  /// Of low faces, by axis.
  std::vector<std::vector<float>> Conductances() const
  {
    std::vector<std::vector<float>> ofAxes;
    for (int axis = 0; axis < 3; ++axis)
    {
      const auto begin = this->Conductance.begin() + static_cast<std::ptrdiff_t>(axis * this->Count);
      ofAxes.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(this->Count));
    }
    return ofAxes;
  }

private:
  std::array<int, 3> At(std::size_t i) const
  {
    const int in = static_cast<int>(i);
    return { in % this->Size[0], in / this->Size[0] % this->Size[1], in / (this->Size[0] * this->Size[1]) };
  }
  std::size_t Before(std::size_t i, int axis) const
  {
    std::array<int, 3> at = this->At(i);
    at[axis] = (at[axis] + this->Size[axis] - 1) % this->Size[axis];
    return (static_cast<std::size_t>(at[2]) * this->Size[1] + at[1]) * this->Size[0] + at[0];
  }

  std::array<int, 3> Size;
  std::size_t Count;
  std::vector<float> Conductance, Loss;
};

std::vector<double> RandomValues(std::size_t count)
{
  std::vector<double> values(count);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::generate(values.begin(), values.end(), [&] { return uniform(random); });
  return values;
}

/// A rank's block with its ghost voxels, which may lie beyond the ends of periodic axes.
struct BlockOfGrid
{
  Grid whole, held;
  VoxelBox box, own;

  BlockOfGrid(const BlockPartition& partition, int rank, const std::array<bool, 3>& periodic)
    : whole(partition.whole)
    , own(partition.blocks[rank])
  {
    this->box = Hull(this->own, LayersBeside(this->own, this->whole.size, periodic));
    this->held.size = this->box.size;
  }

  std::array<int, 3> InWhole(std::size_t i) const
  {
    std::array<int, 3> voxel = this->held.VoxelAt(i);
    for (int axis = 0; axis < 3; ++axis)
    {
      voxel[axis] = (voxel[axis] + this->box.first[axis] + this->whole.size[axis]) % this->whole.size[axis];
    }
    return voxel;
  }

  template <class Value>
  std::vector<Value> Part(const std::vector<Value>& values) const
  {
    std::vector<Value> part;
    for (std::size_t i = 0; i < this->box.VoxelCount(); ++i)
    {
      part.push_back(values[this->whole.IndexOf(this->InWhole(i))]);
    }
    return part;
  }

  /// Values of which those of the ghost voxels at the low end of an axis are 0.
  std::vector<float> WithoutLowEnd(std::vector<float> values, int axis) const
  {
    for (std::size_t i = 0; i < values.size(); ++i)
    {
      const bool atEnd = this->held.VoxelAt(i)[axis] == 0 && this->box.first[axis] < this->own.first[axis];
      values[i] = atEnd ? 0.0f : values[i];
    }
    return values;
  }

  bool IsOwn(std::size_t i) const
  {
    const std::array<int, 3> at = this->held.VoxelAt(i);
    return Common(this->own,
             { { at[0] + this->box.first[0], at[1] + this->box.first[1], at[2] + this->box.first[2] }, { 1, 1, 1 } })
             .VoxelCount() == 1;
  }
};

struct Solution
{
  std::vector<double> values; ///< of the whole grid
  int iterations = 0;         ///< of the last solve
};

class MultigridSolverTest : public DeviceTest
{
protected:
  /// @param solves  each continues from the last one's result
  Solution Solve(const RandomMatrix& matrix, const std::vector<double>& right, const BlockPartition& partition,
    double reduction, const std::array<bool, 3>& periodic = None, int solves = 1)
  {
    Solution found;
    found.values.resize(right.size());
    std::mutex guard;
    RunInThreads(static_cast<int>(partition.blocks.size()), [&](Communicator& communicator) {
      MultigridSolver solver(this->GetDevice(), Domain(communicator, partition), periodic);
      const BlockOfGrid block(partition, communicator.Rank(), periodic);
      std::vector<float> conductance;
      const std::vector<std::vector<float>> ofAxes = matrix.Conductances();
      for (int axis = 0; axis < 3; ++axis)
      {
        const std::vector<float> part = block.WithoutLowEnd(block.Part(ofAxes[axis]), axis);
        conductance.insert(conductance.end(), part.begin(), part.end());
      }
      solver.Conductance().Write(InRows(solver.Rows(), conductance, 3).data());
      solver.Loss().Write(InRows(solver.Rows(), block.Part(matrix.Losses())).data());
      solver.Coarsen();
      ExactValues values(this->GetDevice(), block.box.VoxelCount(), "a test");
      values.Fill(0.0);
      int iterations = 0;
      for (int solve = 0; solve < solves; ++solve) // each from a residual in double
      {
        solver.Right().Write(InRows(solver.Rows(), block.Part(right)).data());
        iterations = solver.Solve(values, 1.0, reduction);
      }
      const std::vector<double> held = values.Read();
      const std::lock_guard<std::mutex> lock(guard);
      found.iterations = iterations;
      for (std::size_t i = 0; i < held.size(); ++i)
      {
        if (block.IsOwn(i))
        {
          found.values[partition.whole.IndexOf(block.InWhole(i))] = held[i];
        }
      }
    });
    return found;
  }

  /// Largest error of the solution of a system with known solution.
  double ErrorOn(
    const std::array<int, 3>& size, const std::array<bool, 3>& periodic, double contrast, int most, int ranks = 1)
  {
    const RandomMatrix matrix(size, periodic, contrast);
    const Grid grid = { size };
    const std::vector<double> truth = RandomValues(grid.VoxelCount());
    const Solution found =
      this->Solve(matrix, matrix.Times(truth), BlockPartition::Even(grid, ranks), 1e-5, periodic, 2);
    EXPECT_LE(found.iterations, most);
    return LargestDifference(found.values, truth);
  }

  static double LargestDifference(const std::vector<double>& a, const std::vector<double>& b)
  {
    double largest = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
    {
      largest = std::max(largest, std::abs(a[i] - b[i]));
    }
    return largest;
  }
};
}

TEST_F(MultigridSolverTest, FindsWhatTheMatrixWasMultipliedWith)
{
  for (const std::array<int, 3>& size : std::vector<std::array<int, 3>>{ { 23, 17, 40 }, { 16, 16, 16 }, { 8, 9, 7 },
         { 5, 3, 2 }, { 129, 1, 9 }, { 1, 1, 64 }, { 1, 31, 1 }, { 2, 2, 2 }, { 20, 16, 16 } })
  {
    for (const int ranks : { 1, 3, 8 })
    {
      EXPECT_LT(this->ErrorOn(size, None, 1.0, 25, ranks), 1e-4)
        << size[0] << " x " << size[1] << " x " << size[2] << " on " << ranks << " ranks";
    }
  }
}

/// Blocks that span the axis from end to end, and such that do not; of one voxel, and of none.
TEST_F(MultigridSolverTest, WrapsAroundPeriodicAxes)
{
  for (const int ranks : { 1, 3, 8 })
  {
    SCOPED_TRACE(std::to_string(ranks) + " ranks");
    for (int axis = 0; axis < 3; ++axis)
    {
      std::array<bool, 3> periodic = None;
      periodic[axis] = true;
      EXPECT_LT(this->ErrorOn({ 19, 12, 24 }, periodic, 1.0, 25, ranks), 1e-4) << axis;
      EXPECT_LT(this->ErrorOn({ 16, 8, 1 }, periodic, 1.0, 25, ranks), 1e-4) << axis;
    }
    EXPECT_LT(this->ErrorOn({ 21, 22, 9 }, { true, true, true }, 1.0, 25, ranks), 1e-4);
    EXPECT_LT(this->ErrorOn({ 2, 1, 3 }, { true, false, true }, 1.0, 25, ranks), 1e-4);
  }
}

TEST_F(MultigridSolverTest, TakesConductancesThatDifferFromFaceToFace)
{
  EXPECT_LT(this->ErrorOn({ 24, 24, 24 }, None, 100.0, 40), 1e-3);
  EXPECT_LT(this->ErrorOn({ 17, 26, 21 }, { false, true, false }, 1e4, 150), 1e-2);
}

/// Blocks that end on odd voxels, of one voxel's width, and without voxels: cells are those of the whole grid, so the
/// iteration is the same.
TEST_F(MultigridSolverTest, IteratesAlikeInUnevenBlocks)
{
  const Grid grid = { { 21, 18, 15 } };
  const RandomMatrix matrix(grid.size, None, 100.0);
  std::vector<double> right(grid.VoxelCount(), 0.0);
  right[grid.IndexOf({ 7, 6, 5 })] = 1.0;
  right[grid.IndexOf({ 15, 1, 9 })] = 3.0;
  const Solution serial = this->Solve(matrix, right, BlockPartition::Even(grid, 1), 1e-3);
  const std::vector<VoxelBox> uneven = { { { 0, 0, 0 }, { 7, 18, 15 } }, { { 7, 0, 0 }, { 1, 18, 15 } }, {},
    { { 8, 0, 0 }, { 13, 5, 15 } }, { { 8, 5, 0 }, { 13, 13, 1 } }, { { 8, 5, 1 }, { 13, 13, 14 } } };
  const Solution found = this->Solve(matrix, right, { grid, uneven }, 1e-3);
  EXPECT_EQ(found.iterations, serial.iterations);
  EXPECT_LT(LargestDifference(found.values, serial.values),
    1e-5 * *std::max_element(serial.values.begin(), serial.values.end()));
}

TEST_F(MultigridSolverTest, TakesHardlyMoreIterationsOnMoreVoxels)
{
  for (const int ranks : { 1, 3 })
  {
    int few = 0;
    for (const std::array<int, 3>& size : std::vector<std::array<int, 3>>{ { 12, 9, 16 }, { 72, 60, 96 } })
    {
      const Grid grid = { size };
      const RandomMatrix matrix(size, None, 1.0, 1e-5f);
      std::vector<double> source(grid.VoxelCount(), 0.0);
      source[source.size() / 3] = 1.0;
      const int iterations = this->Solve(matrix, source, BlockPartition::Even(grid, ranks), 1e-4).iterations;
      few = few > 0 ? few : iterations;
      EXPECT_LE(iterations, few + 1) << ranks;
    }
    EXPECT_GT(few, 1);
  }
}

TEST_F(MultigridSolverTest, FindsNothingWithoutASource)
{
  const Grid grid = { { 9, 9, 9 } };
  const Solution found =
    this->Solve(RandomMatrix(grid.size, None, 1.0), std::vector<double>(729, 0.0), BlockPartition::Even(grid, 1), 1e-3);
  EXPECT_EQ(found.iterations, 0);
  EXPECT_EQ(found.values, std::vector<double>(729, 0.0));
}
