#include "DeviceTest.h"
#include "RandomMatrix.h"

#include "LightPropagation/Diffusion/MultigridSolver.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace
{
using namespace tyndall;

class MultigridSolverTest : public DeviceTest
{
protected:
  /// Largest error of what the solver finds, over the largest value; 1 where it takes too many iterations.
  double ErrorOn(const std::array<int, 3>& size, const std::array<bool, 3>& periodic, double contrast, int most)
  {
    const RandomMatrix matrix(size, periodic, contrast);
    std::vector<double> truth(static_cast<std::size_t>(size[0]) * size[1] * size[2]);
    std::mt19937 random(11);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    std::generate(truth.begin(), truth.end(), [&] { return uniform(random); });

    MultigridSolver solver(this->GetDevice(), size, { 1.0, 1.0, 1.0 });
    matrix.LoadInto(solver);
    ExactValues found(this->GetDevice(), truth.size(), "a test");
    for (int round = 0; round < 2; ++round) // each from a residual in double
    {
      solver.Right().Write(InRows(solver.Rows(), matrix.Times(truth)).data());
      const int iterations = solver.Solve(found, 1.0, 1e-5);
      EXPECT_LE(iterations, most);
    }
    const std::vector<double> values = found.Read();
    double error = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i)
    {
      error = std::max(error, std::abs(values[i] - truth[i]));
    }
    return error;
  }
};

TEST_F(MultigridSolverTest, FindsWhatTheMatrixWasMultipliedWith)
{
  for (const std::array<int, 3>& size : std::vector<std::array<int, 3>>{ { 23, 17, 40 }, { 16, 16, 16 }, { 8, 9, 7 },
         { 5, 3, 2 }, { 129, 1, 9 }, { 1, 1, 64 }, { 1, 31, 1 }, { 2, 2, 2 }, { 20, 16, 16 } })
  {
    EXPECT_LT(this->ErrorOn(size, { false, false, false }, 1.0, 25), 1e-4)
      << size[0] << " x " << size[1] << " x " << size[2];
  }
}

TEST_F(MultigridSolverTest, GoesRoundPeriodicAxes)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    std::array<bool, 3> periodic = { false, false, false };
    periodic[axis] = true;
    EXPECT_LT(this->ErrorOn({ 19, 12, 24 }, periodic, 1.0, 25), 1e-4) << axis;
    EXPECT_LT(this->ErrorOn({ 16, 8, 1 }, periodic, 1.0, 25), 1e-4) << axis;
  }
  EXPECT_LT(this->ErrorOn({ 21, 22, 9 }, { true, true, true }, 1.0, 25), 1e-4);
}

TEST_F(MultigridSolverTest, TakesConductancesThatDifferFromFaceToFace)
{
  EXPECT_LT(this->ErrorOn({ 24, 24, 24 }, { false, false, false }, 100.0, 40), 1e-3);
  EXPECT_LT(this->ErrorOn({ 17, 26, 21 }, { false, true, false }, 1e4, 150), 1e-2);
}

TEST_F(MultigridSolverTest, TakesHardlyMoreIterationsOnMoreVoxels)
{
  int few = 0;
  for (const std::array<int, 3>& size : std::vector<std::array<int, 3>>{ { 12, 9, 16 }, { 72, 60, 96 } })
  {
    const RandomMatrix matrix(size, { false, false, false }, 1.0);
    MultigridSolver solver(this->GetDevice(), size, { 1.0, 1.0, 1.0 });
    matrix.LoadInto(solver);
    const std::size_t count = static_cast<std::size_t>(size[0]) * size[1] * size[2];
    solver.Loss().Write(InRows(solver.Rows(), std::vector<float>(count, 1e-5f)).data()); // the box is one
    solver.Coarsen();
    const ExactValues found(this->GetDevice(), count, "a test");
    std::vector<double> source(count, 0.0);
    source[count / 3] = 1.0;
    solver.Right().Write(InRows(solver.Rows(), source).data());
    const int iterations = solver.Solve(found, 1.0, 1e-4);
    few = few > 0 ? few : iterations;
    EXPECT_LE(iterations, few + 1);
  }
  EXPECT_GT(few, 1);
}

TEST_F(MultigridSolverTest, FindsNothingWhereNothingShines)
{
  const RandomMatrix matrix({ 9, 9, 9 }, { false, false, false }, 1.0);
  MultigridSolver solver(this->GetDevice(), { 9, 9, 9 }, { 1.0, 1.0, 1.0 });
  matrix.LoadInto(solver);
  const ExactValues found(this->GetDevice(), 729, "a test");
  EXPECT_EQ(solver.Solve(found, 1.0, 1e-3), 0);
  for (double value : found.Read())
  {
    EXPECT_EQ(value, 0.0);
  }
}
}
