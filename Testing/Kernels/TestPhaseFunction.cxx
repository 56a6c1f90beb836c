#include "Device/Errors.h"
#include "ErrorWords.h"
#include "Medium/Medium.h"
#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"
#include "PhaseFunction/PhaseFunction.h"
#include "PhaseFunction/PhaseOfMedium.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

using namespace tyndall;
using testing::AllOf;
using testing::HasSubstr;

namespace
{
struct Named
{
  std::string name;
  PhaseFunction function;
  double g; ///< mean cosine
};

/// What Mie codes print: scattering angles from 0 to 180 degrees, so cosines that fall; intensities of any scale.
PhaseFunction AsMieCodesPrint(double g)
{
  std::vector<double> cosines, values;
  for (int quarterDegrees = 0; quarterDegrees <= 720; ++quarterDegrees)
  {
    cosines.push_back(std::cos(0.25 * quarterDegrees * Pi / 180.0));
    values.push_back(1e5 / std::pow(1.0 + g * g - 2.0 * g * cosines.back(), 1.5));
  }
  return PhaseFunction::Tabulated(cosines, values);
}

/// A line through the whole sphere, 1 + 3 g c.
PhaseFunction LineOf(double g)
{
  return PhaseFunction::Tabulated({ -1.0, 1.0 }, { 1.0 - 3.0 * g, 1.0 + 3.0 * g });
}

std::vector<Named> AllFunctions()
{
  std::vector<Named> all = { { "isotropic", PhaseFunction(), 0.0 }, { "Rayleigh", PhaseFunction::Rayleigh(), 0.0 },
    { "line", LineOf(0.3), 0.3 }, { "falling line", LineOf(-0.25), -0.25 } };
  for (const double g : { 1e-9, 1e-5, 1e-3, 0.1, 0.5, 0.85, 0.99, 0.999 })
  {
    for (const double sign : { 1.0, -1.0 })
    {
      const std::string text = " of g " + std::to_string(sign * g);
      all.push_back({ "Henyey-Greenstein" + text, PhaseFunction::HenyeyGreenstein(sign * g), sign * g });
      all.push_back({ "Schlick" + text, PhaseFunction::Schlick(sign * g), sign * g });
      all.push_back({ "double Henyey-Greenstein" + text, PhaseFunction::DoubleHenyeyGreenstein(sign * g, -0.4, 0.7),
        0.7 * sign * g - 0.4 * 0.3 });
    }
  }
  return all;
}

/// 2 pi times the integral of f over cosines from `low` to `high`, in stretches that halve towards -1 and 1.
double OverCosines(const std::function<double(double)>& f, double low = -1.0, double high = 1.0)
{
  static const GaussLegendre rule(40);
  std::vector<double> ends = { low, high };
  for (double away = 1.0; away > 1e-12; away *= 0.5)
  {
    for (const double end : { away - 1.0, 1.0 - away })
    {
      if (end > low && end < high)
      {
        ends.push_back(end);
      }
    }
  }
  std::sort(ends.begin(), ends.end());
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
  {
    const double half = 0.5 * (ends[i + 1] - ends[i]);
    for (std::size_t k = 0; k < rule.points.size(); ++k)
    {
      sum += 2.0 * Pi * half * rule.weights[k] * f(ends[i] + half * (1.0 + rule.points[k]));
    }
  }
  return sum;
}

std::string TableMessage(const std::vector<double>& cosines, const std::vector<double>& values)
{
  return ErrorWords([&] { PhaseFunction::Tabulated(cosines, values); });
}

constexpr double NoNumber = std::numeric_limits<double>::quiet_NaN();
}

TEST(PhaseFunction, ScattersAllLightThatItTakes)
{
  for (const Named& named : AllFunctions())
  {
    EXPECT_NEAR(OverCosines([&](double c) { return named.function.Value(c); }), 1.0, 1e-9) << named.name;
  }
}

TEST(PhaseFunction, HasTheMeanCosineItWasMadeWith)
{
  for (const Named& named : AllFunctions())
  {
    EXPECT_NEAR(OverCosines([&](double c) { return c * named.function.Value(c); }), named.g, 1e-9) << named.name;
    EXPECT_NEAR(named.function.MeanCosine(), named.g, 1e-9) << named.name;
  }
}

TEST(PhaseFunction, IsNowhereNegativeAndFiniteToBothPoles)
{
  for (const Named& named : AllFunctions())
  {
    for (const double c : { -1.0, -0.999999, -0.5, 0.0, 0.5, 0.999999, 1.0 })
    {
      EXPECT_GE(named.function.Value(c), 0.0) << named.name << " at " << c;
      EXPECT_TRUE(std::isfinite(named.function.Value(c))) << named.name << " at " << c;
    }
  }
}

TEST(PhaseFunction, BackwardsMirrorsForwards)
{
  for (const double g : { 0.3, 0.99, 0.9999999 })
  {
    for (const double c : { -1.0, -0.3, 0.9, 1.0 })
    {
      const double forwards = PhaseFunction::HenyeyGreenstein(g).Value(c);
      EXPECT_NEAR(PhaseFunction::HenyeyGreenstein(-g).Value(-c), forwards, 1e-12 * forwards) << g << " " << c;
      const double schlick = PhaseFunction::Schlick(g).Value(c);
      EXPECT_NEAR(PhaseFunction::Schlick(-g).Value(-c), schlick, 1e-12 * schlick) << g << " " << c;
    }
  }
}

/// A direction is rounded to floats; the cosine is of either order, and of either sign of both.
TEST(PhaseFunction, IsReciprocal)
{
  const std::array<float, 3> from = { 0.36f, 0.48f, 0.8f }, to = { 0.6f, -0.64f, 0.48f };
  const auto cosine = [](const std::array<float, 3>& a, const std::array<float, 3>& b, double sign) {
    return a[0] * sign * b[0] + a[1] * sign * b[1] + a[2] * sign * b[2];
  };
  for (const Named& named : AllFunctions())
  {
    const double there = named.function.Value(cosine(from, to, 1.0));
    EXPECT_GT(there, 0.0) << named.name;
    EXPECT_NEAR(named.function.Value(-cosine(to, from, -1.0)), there, 1e-6 * there) << named.name;
  }
}

TEST(PhaseFunction, HasTheMomentsOfAQuadrature)
{
  for (const Named& named : AllFunctions())
  {
    const std::vector<double> moments = named.function.Moments(12);
    ASSERT_EQ(moments.size(), 13u);
    for (int l = 0; l <= 12; ++l)
    {
      const double expected =
        OverCosines([&](double c) { return named.function.Value(c) * LegendrePolynomials(l, c)[l]; });
      EXPECT_NEAR(moments[l], expected, 1e-9) << named.name << ", degree " << l;
    }
  }
}

TEST(PhaseFunction, HasItsMomentsWhateverDegreeIsAskedFor)
{
  for (const Named& named : AllFunctions())
  {
    const std::vector<double> many = named.function.Moments(40);
    for (const int degree : { 0, 1, 3 })
    {
      const std::vector<double> few = named.function.Moments(degree);
      ASSERT_EQ(few.size(), degree + 1u);
      EXPECT_NEAR(few[degree], many[degree], 1e-9) << named.name;
    }
  }
}

/// Henyey and Greenstein's are powers of g.
TEST(PhaseFunction, OfATableHasTheMomentsOfWhatItSamples)
{
  const std::vector<double> moments = AsMieCodesPrint(0.85).Moments(8);
  for (int l = 0; l <= 8; ++l)
  {
    EXPECT_NEAR(moments[l], std::pow(0.85, l), 1e-4) << l;
  }
}

TEST(PhaseFunction, SamplesItsOwnDistribution)
{
  for (const Named& named : AllFunctions())
  {
    for (const double u : { 1e-6, 0.001, 0.1, 0.5, 0.77, 0.999, 1.0 - 1e-6 })
    {
      const double cosine = named.function.CosineAt(u);
      ASSERT_GE(cosine, -1.0) << named.name;
      ASSERT_LE(cosine, 1.0) << named.name;
      const double below = OverCosines([&](double c) { return named.function.Value(c); }, -1.0, cosine);
      EXPECT_NEAR(below, u, 1e-8) << named.name << " at " << u;
      EXPECT_NEAR(named.function.Below(cosine), u, 1e-8) << named.name << " at " << u;
    }
  }
}

TEST(PhaseFunction, SamplesFromPoleToPole)
{
  for (const Named& named : AllFunctions())
  {
    EXPECT_NEAR(named.function.CosineAt(0.0), -1.0, 1e-9) << named.name;
    EXPECT_NEAR(named.function.CosineAt(1.0), 1.0, 1e-9) << named.name;
  }
}

TEST(PhaseFunction, DoubleOfOnePartIsTheSingle)
{
  const PhaseFunction one = PhaseFunction::HenyeyGreenstein(0.8);
  for (const double c : { -1.0, 0.2, 1.0 })
  {
    EXPECT_DOUBLE_EQ(PhaseFunction::DoubleHenyeyGreenstein(0.8, -0.5, 1.0).Value(c), one.Value(c));
    EXPECT_DOUBLE_EQ(PhaseFunction::DoubleHenyeyGreenstein(-0.5, 0.8, 0.0).Value(c), one.Value(c));
  }
}

TEST(PhaseFunction, WithoutMeanCosineIsIsotropic)
{
  for (const PhaseFunction& none : { PhaseFunction(), PhaseFunction::HenyeyGreenstein(0.0), PhaseFunction::Schlick(0.0),
         PhaseFunction::DoubleHenyeyGreenstein(0.0, 0.0, 0.5) })
  {
    EXPECT_TRUE(none.IsIsotropic());
    EXPECT_TRUE(none == PhaseFunction());
    EXPECT_DOUBLE_EQ(none.Value(0.3), 1.0 / (4.0 * Pi));
  }
  EXPECT_FALSE(PhaseFunction::Rayleigh().IsIsotropic()) << "it has none either, but a second moment";
}

TEST(PhaseFunction, KeepsItsKindWithAnotherMeanCosine)
{
  EXPECT_TRUE(PhaseFunction::Schlick(0.0).WithMeanCosine(0.7) == PhaseFunction::Schlick(0.7));
  EXPECT_TRUE(PhaseFunction::Schlick(0.5).WithMeanCosine(0.0).WithMeanCosine(0.7) == PhaseFunction::Schlick(0.7));
  EXPECT_TRUE(PhaseFunction::HenyeyGreenstein(0.5).WithMeanCosine(-0.7) == PhaseFunction::HenyeyGreenstein(-0.7));
  EXPECT_THAT(ErrorWords([] { PhaseFunction::Rayleigh().WithMeanCosine(0.1); }), HasSubstr("varies by voxel"));
}

TEST(PhaseFunctionTable, IsTheSameRisingFallingAndInAnyUnit)
{
  const PhaseFunction rising = PhaseFunction::Tabulated({ -1.0, 0.0, 0.5, 1.0 }, { 1.0, 2.0, 3.0, 10.0 });
  const PhaseFunction falling = PhaseFunction::Tabulated({ 1.0, 0.5, 0.0, -1.0 }, { 1e9, 3e8, 2e8, 1e8 });
  for (const double c : { -1.0, -0.4, 0.0, 0.3, 0.9, 1.0 })
  {
    EXPECT_NEAR(rising.Value(c), falling.Value(c), 1e-12) << c;
  }
  EXPECT_NEAR(rising.Value(1.0) / rising.Value(-1.0), 10.0, 1e-12);
  EXPECT_NEAR(rising.Value(0.25) / rising.Value(-1.0), 2.5, 1e-12) << "linear between rows";
}

TEST(PhaseFunctionTable, TakesValuesThatFloatsOverflowOn)
{
  const PhaseFunction large = PhaseFunction::Tabulated({ -1.0, 1.0 }, { 1e308, 1e308 });
  EXPECT_NEAR(large.Value(0.0), 1.0 / (4.0 * Pi), 1e-15);
}

TEST(PhaseFunctionTable, MayEndBesideThePoles)
{
  const PhaseFunction near = PhaseFunction::Tabulated({ -0.9995, 0.0, 0.9999999 }, { 1.0, 1.0, 1.0 });
  EXPECT_NEAR(near.Value(1.0), 1.0 / (4.0 * Pi), 1e-12);
  EXPECT_NEAR(near.CosineAt(0.0), -1.0, 1e-12);
}

TEST(PhaseFunctionTable, MayBeDarkInParts)
{
  const PhaseFunction dark = PhaseFunction::Tabulated({ -1.0, 0.0, 0.5, 1.0 }, { 0.0, 0.0, 1.0, 0.0 });
  for (const double u : { 0.0, 0.25, 0.5, 1.0 })
  {
    const double cosine = dark.CosineAt(u);
    EXPECT_NEAR(OverCosines([&](double c) { return dark.Value(c); }, -1.0, cosine), u, 1e-4) << u;
  }
  EXPECT_GE(dark.CosineAt(1e-12), 0.0) << "no light goes where the table is dark";
}

TEST(PhaseFunctionBadInput, RefusesMeanCosinesFromOneOn)
{
  for (const double g : { 1.0, -1.0, 1.5, std::numeric_limits<double>::infinity(), NoNumber })
  {
    EXPECT_THAT(ErrorWords([&] { PhaseFunction::HenyeyGreenstein(g); }), HasSubstr("must lie between -1 and 1")) << g;
    EXPECT_THAT(ErrorWords([&] { PhaseFunction::Schlick(g); }), HasSubstr("must lie between -1 and 1")) << g;
    EXPECT_THAT(
      ErrorWords([&] { PhaseFunction::DoubleHenyeyGreenstein(0.1, g, 0.5); }), HasSubstr("must lie between -1 and 1"))
      << g;
  }
  EXPECT_THAT(ErrorWords([] { PhaseFunction::HenyeyGreenstein(1.5); }), HasSubstr("1.5"));
}

TEST(PhaseFunctionBadInput, RefusesPartsBeyondTheWhole)
{
  for (const double part : { -0.1, 1.1, NoNumber })
  {
    EXPECT_THAT(ErrorWords([&] { PhaseFunction::DoubleHenyeyGreenstein(0.1, 0.2, part); }), HasSubstr("from 0 to 1"))
      << part;
  }
}

TEST(PhaseFunctionBadInput, NamesTheRowThatIsNegative)
{
  EXPECT_THAT(TableMessage({ -1.0, 0.0, 1.0 }, { 1.0, -0.5, 1.0 }),
    AllOf(HasSubstr("Row 1 "), HasSubstr("value -0.5"), HasSubstr("negative")));
}

TEST(PhaseFunctionBadInput, NamesTheRowThatIsNoNumber)
{
  EXPECT_THAT(TableMessage({ -1.0, 0.0, 1.0 }, { 1.0, 1.0, NoNumber }),
    AllOf(HasSubstr("Row 2 "), HasSubstr("not a finite number")));
  EXPECT_THAT(TableMessage({ -1.0, 0.0, NoNumber }, { 1.0, 1.0, 1.0 }),
    AllOf(HasSubstr("Row 2 "), HasSubstr("not a finite number")));
  EXPECT_THAT(TableMessage({ NoNumber, 0.0, 1.0 }, { 1.0, 1.0, 1.0 }), HasSubstr("Row 0 "));
  EXPECT_THAT(TableMessage({ -1.0, 0.0, 1.0 }, { 1.0, std::numeric_limits<double>::infinity(), 1.0 }),
    AllOf(HasSubstr("Row 1 "), HasSubstr("not a finite number")));
}

TEST(PhaseFunctionBadInput, NamesTheRowThatIsOutOfOrder)
{
  EXPECT_THAT(
    TableMessage({ -1.0, 0.5, 0.0, 1.0 }, { 1.0, 1.0, 1.0, 1.0 }), AllOf(HasSubstr("Row 2 "), HasSubstr("order")));
  EXPECT_THAT(
    TableMessage({ 1.0, 0.5, 0.6, -1.0 }, { 1.0, 1.0, 1.0, 1.0 }), AllOf(HasSubstr("Row 2 "), HasSubstr("order")));
  EXPECT_THAT(TableMessage({ -1.0, 0.0, 0.0, 1.0 }, { 1.0, 1.0, 2.0, 1.0 }), HasSubstr("Row 2 "));
  EXPECT_THAT(TableMessage({ -1.0, 0.5, 1.0, 1.0 + 1e-10 }, { 1.0, 1.0, 1.0, 1.0 }), HasSubstr("Row 3 "));
}

TEST(PhaseFunctionBadInput, RefusesAngles)
{
  EXPECT_THAT(TableMessage({ 0.0, 1.0, 90.0, 180.0 }, { 1.0, 1.0, 1.0, 1.0 }),
    AllOf(HasSubstr("Row 2 "), HasSubstr("no cosine")));
  EXPECT_THAT(
    TableMessage({ 0.0, 0.9, 1.8, 3.14159 }, { 1.0, 1.0, 1.0, 1.0 }), AllOf(HasSubstr("Row 2 "), HasSubstr("Angles")));
}

TEST(PhaseFunctionBadInput, NamesTheEndThatIsMissing)
{
  EXPECT_THAT(TableMessage({ 0.0, 1.0 }, { 1.0, 1.0 }), AllOf(HasSubstr("Row 0 "), HasSubstr("from cosine -1 to 1")));
  EXPECT_THAT(TableMessage({ -1.0, 0.9 }, { 1.0, 1.0 }), HasSubstr("Row 1 "));
  EXPECT_THAT(TableMessage({ 0.9995, 1.0 }, { 1.0, 1.0 }), HasSubstr("from cosine -1 to 1"));
}

TEST(PhaseFunctionBadInput, RefusesFewerThanTwoRows)
{
  EXPECT_THAT(TableMessage({ 1.0 }, { 1.0 }), AllOf(HasSubstr("1 row;"), HasSubstr("two at least")));
  EXPECT_THAT(TableMessage({}, {}), HasSubstr("0 rows;"));
  EXPECT_THAT(TableMessage({ -1.0, 0.0, 1.0 }, { 1.0, 1.0 }), HasSubstr("3 cosines and 2 values"));
}

TEST(PhaseFunctionBadInput, RefusesATableThatIsZero)
{
  EXPECT_THAT(TableMessage({ -1.0, 0.0, 1.0 }, { 0.0, 0.0, 0.0 }), HasSubstr("does not integrate"));
}

TEST(PhaseOfMedium, SaysWhetherItVariesAndHasColour)
{
  EXPECT_TRUE(PhaseOfMedium().IsIsotropic());
  const PhaseOfMedium one(PhaseFunction::HenyeyGreenstein(0.5));
  EXPECT_FALSE(one.IsIsotropic());
  EXPECT_FALSE(one.HasColour());
  EXPECT_FALSE(one.Varies());
  const PhaseOfMedium coloured(std::array<PhaseFunction, 3>{
    PhaseFunction::HenyeyGreenstein(0.0), PhaseFunction::HenyeyGreenstein(0.5), PhaseFunction::HenyeyGreenstein(0.6) });
  EXPECT_TRUE(coloured.HasColour());
  EXPECT_FALSE(coloured.IsIsotropic());
  EXPECT_DOUBLE_EQ(coloured.MeanCosine(3, 2), 0.6);
}

TEST(PhaseOfMedium, TakesTheMeanCosineOfEachVoxel)
{
  const std::vector<float> g = { 0.25f, -0.5f, 0.75f, 0.0f, 0.125f, 0.5f };
  const PhaseOfMedium byVoxel(PhaseFunction::Schlick(0.0), Field{ g.data(), 3 });
  EXPECT_TRUE(byVoxel.Varies() && byVoxel.HasColour());
  EXPECT_FALSE(byVoxel.IsIsotropic());
  EXPECT_EQ(byVoxel.MeanCosine(1, 2), 0.5);
  EXPECT_TRUE(byVoxel.At(0, 1) == PhaseFunction::Schlick(-0.5));
  EXPECT_TRUE(byVoxel.Seen(2).At(1, 0) == PhaseFunction::Schlick(0.5)) << "as blue sees it";
  EXPECT_FALSE(byVoxel.Seen(2).HasColour());
  EXPECT_THROW(PhaseOfMedium(PhaseFunction::Rayleigh(), Field{ g.data(), 3 }), InvalidInput);
}

TEST(PhaseOfMedium, IsCheckedInEveryVoxel)
{
  Medium medium;
  medium.grid.size = { 2, 2, 1 };
  std::vector<float> g = { 0.1f, 0.2f, -0.99f, 0.999f };
  medium.phase = PhaseOfMedium(PhaseFunction::HenyeyGreenstein(0.0), Field{ g.data() });
  EXPECT_EQ(ErrorWords([&] { Check(medium); }), "");
  for (const float bad : { 1.0f, -1.0f, static_cast<float>(NoNumber) })
  {
    g[2] = bad;
    EXPECT_THAT(ErrorWords([&] { Check(medium); }), AllOf(HasSubstr("mean cosine g"), HasSubstr("voxel (0, 1, 0)")));
  }
}

// A solver's transport cross section may be twice sigma_s.
TEST(PhaseOfMedium, CountsForTheLargestExtinctionInEveryChannel)
{
  Medium medium;
  medium.grid.size = { 1, 1, 1 };
  const float sigma_s = 0.6e37f;
  medium.sigma_s = { &sigma_s };
  medium.phase = PhaseOfMedium(
    std::array<PhaseFunction, 3>{ PhaseFunction(), PhaseFunction(), PhaseFunction::HenyeyGreenstein(0.5) });
  EXPECT_EQ(ErrorWords([&] { Check(medium); }), "");
  medium.phase = PhaseOfMedium(
    std::array<PhaseFunction, 3>{ PhaseFunction(), PhaseFunction(), PhaseFunction::HenyeyGreenstein(-0.9) });
  EXPECT_THAT(ErrorWords([&] { Check(medium); }), HasSubstr("sigma_a and sigma_s add up to"));
}
