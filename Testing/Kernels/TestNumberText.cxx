// Numbers as text under a locale with a decimal comma; TestDecimalComma of the filters has files and messages.
#include "DeviceTest.h"
#include "MediumScene.h"

#include "Numerics/NumberText.h"
#include "Reference/CommaLocale.h"

#include <cstdio>
#include <limits>
#include <string>

using namespace tyndall;

TEST(NumberText, IsWhatPrintfWritesWithoutALocale)
{
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double value : { 0.0, -0.0, 0.02, 1.0 / 3.0, 1e300, -1e-300, 5e-324, 123456789.0, 65504.0, infinite })
  {
    for (const char* format : { "%g", "%.3g", "%.17g", "%.0f", "%.2f", "%f", "%.8e" })
    {
      char expected[400];
      std::snprintf(expected, sizeof(expected), format, value);
      EXPECT_EQ(Text(format, value), expected) << format;
    }
  }
}

TEST(NumberText, IsReadToTheLastBit)
{
  for (const double value : { 0.0, 1.0 / 3.0, -1e300, 5e-324, 2.2250738585072014e-308 })
  {
    EXPECT_EQ(NumberIn(Text("%.17g", value)), value);
  }
  EXPECT_EQ(NumberIn(" \t+1.5 W"), 1.5);
  EXPECT_EQ(NumberIn("0,5"), 0.0) << "a comma ends a number";
  for (const char* none : { "", " ", "+", "+-1", "W 1", "1e999" })
  {
    EXPECT_FALSE(NumberIn(none)) << none;
  }
}

TEST(NumberText, HasAPointUnderADecimalComma)
{
  const reference::CommaLocale locale;
  ASSERT_TRUE(locale.Works);
  ASSERT_EQ(std::to_string(0.5), "0,500000") << "the locale is one with a comma";
  EXPECT_EQ(Text("%g", 0.02), "0.02");
  EXPECT_EQ(Text("%.0f", 1234567.0), "1234567");
  EXPECT_EQ(FloatLiteral(0.02f), "1.99999996e-02f");
  EXPECT_EQ(NumberIn("0.02"), 0.02);
}

class DecimalComma : public DeviceTest
{
};

TEST_F(DecimalComma, ChangesNoLamp)
{
  const auto solve = [this] {
    Scene scene({ 6, 7, 8 });
    scene.Randomise(4.0, 4.0, 0.75); // thick voxels beside thin ones: the kernel has a number of its own for them
    scene.light.lights = { PointLamp({ 3.1, 2.9, 4.2 }, { 10.0, 10.0, 10.0 }) };
    return scene.Solve(this->GetDevice()).fluence;
  };
  std::vector<float> fluence;
  {
    const reference::CommaLocale locale;
    ASSERT_TRUE(locale.Works);
    fluence = solve();
  }
  EXPECT_EQ(fluence, solve());
}
