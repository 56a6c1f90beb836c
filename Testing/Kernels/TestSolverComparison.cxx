#include "Comparison/ComparisonErrors.h"
#include "Comparison/SolverComparison.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{
using namespace tyndall;

ComparisonRow Row(double seconds, double error, ComparedMethod method = ComparedMethod::LightPropagationMaps)
{
  ComparisonRow row;
  row.method = method;
  row.seconds = seconds;
  row.errorL2 = error;
  return row;
}

TEST(SolverComparison, FindsTheFrontOfAMadeTable)
{
  std::vector<ComparisonRow> rows = { Row(1.0, 0.1), Row(2.0, 0.1), Row(2.0, 0.05), Row(4.0, 0.06), Row(8.0, 0.01),
    Row(0.5, std::nan("")), Row(0.5, 0.2, ComparedMethod::Photons), Row(0.6, 0.3, ComparedMethod::AdaptivePhotons) };
  MarkPareto(rows);
  const bool expected[] = { true, false, true, false, true, false, true, false };
  for (std::size_t i = 0; i < rows.size(); ++i)
  {
    EXPECT_EQ(rows[i].pareto, expected[i]) << "row " << i;
  }
}

TEST(SolverComparison, KeepsBothOfTwoThatAreAlike)
{
  std::vector<ComparisonRow> rows = { Row(1.0, 0.1), Row(1.0, 0.1) };
  MarkPareto(rows);
  EXPECT_TRUE(rows[0].pareto);
  EXPECT_TRUE(rows[1].pareto);
}

TEST(SolverComparison, MeasuresErrorsAgainstTheReferenceAlone)
{
  const RelativeErrors errors = ErrorsOf({ 3.0f, 4.5f, 7.0f }, { 3.0f, 4.0f, std::nanf("") });
  EXPECT_NEAR(errors.l2, 0.5 / 5.0, 1e-12);
  EXPECT_NEAR(errors.max, 0.5 / 4.0, 1e-12);
  EXPECT_NEAR(errors.relative, 0.125 / std::sqrt(2.0), 1e-12);
  EXPECT_TRUE(std::isnan(ErrorsOf({ 1.0f }, { 0.0f }).l2)) << "there is no error relative to the dark";
  EXPECT_TRUE(std::isnan(ErrorsOf({ 1.0f, std::nanf("") }, { 1.0f, 1.0f }).max)) << "light that is no number shows";
}

TEST(GridTransfer, AveragesWhatItRepeats)
{
  Grid fine;
  fine.size = { 4, 2, 1 };
  fine.spacing = { 0.5, 1.0, 3.0 };
  const std::optional<Factors> factors = CoarseningBy(2, fine);
  ASSERT_TRUE(factors);
  EXPECT_EQ(*factors, (Factors{ 2, 2, 1 })) << "an axis of one voxel stays";
  const std::vector<float> means = Averaged(std::vector<float>{ 1, 2, 3, 4, 5, 6, 7, 8 }.data(), 1, fine, *factors);
  EXPECT_EQ(means, (std::vector<float>{ 3.5f, 5.5f }));
  const Grid coarse = Coarsened(fine, *factors);
  EXPECT_EQ(coarse.size, (std::array<int, 3>{ 2, 1, 1 }));
  const std::vector<float> repeated = Repeated(means.data(), 1, coarse, *factors);
  EXPECT_EQ(repeated, (std::vector<float>{ 3.5f, 3.5f, 5.5f, 5.5f, 3.5f, 3.5f, 5.5f, 5.5f }));
  EXPECT_EQ(Averaged(repeated.data(), 1, fine, *factors), means);
}

TEST(GridTransfer, KnowsWhichGridsFit)
{
  Grid fine;
  fine.size = { 6, 6, 6 };
  EXPECT_FALSE(CoarseningBy(4, fine));
  Grid coarse = Coarsened(fine, { 3, 2, 1 });
  EXPECT_EQ(FactorsBetween(fine, coarse), (Factors{ 3, 2, 1 }));
  EXPECT_FALSE(FactorsBetween(coarse, fine));
  coarse.origin[1] += 0.1;
  EXPECT_FALSE(FactorsBetween(fine, coarse));
}
}
