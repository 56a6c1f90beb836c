#include "Viewing/ToneMapping.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

using namespace tyndall;

namespace
{
TEST(ToneMapping, FollowsSrgb)
{
  ToneMapping linear;
  linear.exposure = 2.0;
  linear.curve = ToneCurve::Linear;
  const auto colour = ToneMap({ 0.0f, 0.25f, 0.0015f, 0.1f, 0.5f, 1e30f }, {}, linear);
  const std::vector<std::uint8_t> expected = { 0, 188, 10, 255, 124, 255, 255, 255 };
  EXPECT_EQ(expected, colour);
}

TEST(ToneMapping, IsMonotonousAndEndsAtWhite)
{
  for (ToneCurve curve : { ToneCurve::Linear, ToneCurve::Filmic })
  {
    ToneMapping settings;
    settings.exposure = 1.0;
    settings.curve = curve;
    int last = 0;
    for (double x = 0.0; x < 100.0; x += 0.01)
    {
      const float value = static_cast<float>(x);
      const int shown = ToneMap({ value, value, value }, {}, settings)[0];
      EXPECT_GE(shown, last);
      last = shown;
    }
    EXPECT_EQ(255, last);
  }
}

TEST(ToneMapping, ShowsTheColourThatRadianceWasChosenFor)
{
  for (ToneCurve curve : { ToneCurve::Linear, ToneCurve::Filmic })
  {
    ToneMapping settings;
    settings.exposure = 3.7;
    settings.curve = curve;
    for (int shown = 0; shown < 256; ++shown)
    {
      const auto radiance = static_cast<float>(ExposedAs(shown / 255.0, curve) / settings.exposure);
      EXPECT_EQ(shown, ToneMap({ radiance, 0.0f, 0.0f }, {}, settings)[0]);
    }
  }
}

TEST(ToneMapping, ExposesTheMeanAsAGreyCard)
{
  EXPECT_NEAR(0.18 / 3.0, AutomaticExposure({ 1.0f, 1.0f, 1.0f, 9.0f, 9.0f, 9.0f, 0.0f, 0.0f, 0.0f }, {}), 2e-4);
  EXPECT_EQ(1.0, AutomaticExposure({ 0.0f, 0.0f, 0.0f }, {}));
}

TEST(ToneMapping, ExposesThinSmokeAsThickSmoke)
{
  // Smoke of radiance 0.2 that fills all, a half, a fifth of the pixels, and before a background as bright.
  const std::vector<float> filled = { 1.0f, 0.5f, 0.2f, 0.0f };
  std::vector<float> radiance, before;
  for (const float alpha : filled)
  {
    radiance.insert(radiance.end(), 3, 0.2f * alpha);
    before.insert(before.end(), 3, 0.2f);
  }
  EXPECT_NEAR(0.9, AutomaticExposure(radiance, filled), 3e-3);
  EXPECT_NEAR(0.9, AutomaticExposure(before, {}), 3e-3);
  // What is hardly seen counts little: the bright core does not become white.
  const std::vector<float> wisps = { 1.0f, 0.01f, 0.01f, 0.01f };
  std::vector<float> seen;
  for (const float alpha : wisps)
  {
    seen.insert(seen.end(), 3, 0.2f * alpha);
  }
  EXPECT_LT(AutomaticExposure(seen, wisps) * 0.2, 0.4);
  // What shines by itself and fills nothing is seen all the same.
  EXPECT_NEAR(0.18 * ThinnestPart, AutomaticExposure({ 1.0f, 1.0f, 1.0f }, { 0.0f }), 2e-4);
}

TEST(ToneMapping, IsNotBlindedByWhatIsNearlyBlack)
{
  std::vector<float> radiance(300, 1e-20f);
  std::fill_n(radiance.begin(), 60, 2.0f);
  EXPECT_NEAR(0.09, AutomaticExposure(radiance, {}), 3e-4);
  std::fill_n(radiance.begin(), 6, 1e5f); // a sun
  EXPECT_NEAR(0.09, AutomaticExposure(radiance, {}), 0.07);
}

TEST(ToneMapping, ColoursLaidOverBlackAreThePicture)
{
  for (const ToneCurve curve : { ToneCurve::Linear, ToneCurve::Filmic })
  {
    ToneMapping settings;
    settings.exposure = 1.0;
    settings.curve = curve;
    for (const float alpha : { 1.0f, 0.9f, 0.5f, 0.2f, 0.03f, 0.001f, 0.0f })
    {
      const std::vector<float> radiance = { 0.1f, 0.03f, 0.002f };
      const auto opaque = ToneMap(radiance, {}, settings), seen = ToneMap(radiance, { alpha }, settings);
      for (int c = 0; c < 3; ++c)
      {
        EXPECT_NEAR(opaque[c], seen[c] * seen[3] / 255.0, 1.0) << "alpha " << alpha;
      }
      EXPECT_GE(seen[3], std::floor(255.0f * alpha + 0.5f)) << "hides what its alpha says at least";
    }
  }
}

TEST(ToneMapping, HidesWhatIsBehindAsTheMediumDoes)
{
  ToneMapping settings;
  settings.exposure = 1.0;
  EXPECT_EQ(128, ToneMap({ 0.1f, 0.1f, 0.1f }, { 0.5f }, settings)[3]);
  EXPECT_EQ(26, ToneMap({ 0.0f, 0.0f, 0.0f }, { 0.1f }, settings)[3]) << "smoke in the dark";
  EXPECT_EQ(0, ToneMap({ 0.0f, 0.0f, 0.0f }, { 0.0f }, settings)[3]);
}
}
