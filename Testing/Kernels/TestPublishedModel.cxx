#include "LightPropagation/Published/PublishedModel.h"
#include "LightPropagation/Published/SequentialPropagation.h"
#include "RandomMedium.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace tyndall;

namespace
{
}

TEST(GridWalk, FillsEveryPlane)
{
  for (const auto& [slopeU, slopeV] : { std::pair{ 0.4, -0.8 }, { 0.0, 1.0 }, { -3.7, 0.1 }, { 1.0, -1.0 } })
  {
    GridWalk walk(0.5, 1.0 / 6.0, slopeU, slopeV, 5);
    std::array<double, 5> length = {};
    int u = 0;
    int v = 0;
    while (walk.Next())
    {
      length[walk.plane] += walk.fraction;
      u += walk.moveU;
      v += walk.moveV;
    }
    for (const double l : length)
    {
      EXPECT_NEAR(l, 1.0, 1e-12);
    }
    EXPECT_NEAR(u, 0.5 + 5 * slopeU, 1.0);
    EXPECT_NEAR(v, 1.0 / 6.0 + 5 * slopeV, 1.0);
  }
}

TEST(GridWalk, CrossesAnEdgeAtOnce)
{
  GridWalk walk(0.5, 0.5, 0.8, -0.8, 2);
  int segments = 0;
  while (walk.Next())
  {
    EXPECT_EQ(walk.moveU, -walk.moveV);
    EXPECT_GT(walk.fraction, 0.01);
    ++segments;
  }
  EXPECT_EQ(segments, 4);
}

namespace
{
std::vector<PhaseFunction> ManyFunctions()
{
  std::vector<double> cosines, values;
  for (int degree = 0; degree <= 180; ++degree)
  {
    cosines.push_back(std::cos(degree * Pi / 180.0));
    values.push_back(PhaseFunction::HenyeyGreenstein(0.6).Value(cosines.back()));
  }
  return { PhaseFunction::HenyeyGreenstein(-0.5), PhaseFunction::HenyeyGreenstein(0.3),
    PhaseFunction::HenyeyGreenstein(0.9), PhaseFunction::HenyeyGreenstein(0.99),
    PhaseFunction::HenyeyGreenstein(0.9999), PhaseFunction::HenyeyGreenstein(-0.999), PhaseFunction::Schlick(0.7),
    PhaseFunction::Rayleigh(), PhaseFunction::DoubleHenyeyGreenstein(0.8, -0.4, 0.7),
    PhaseFunction::Tabulated(cosines, values) };
}

/// Mean cosine between propagation directions and the stored directions that they scatter to, by power.
double MeanCosineOf(const PublishedModel& model)
{
  double forward = 0.0, all = 0.0;
  for (std::size_t i = 0; i < model.Directions().directions.size(); ++i)
  {
    for (std::size_t d = 0; d < model.SourceDirections().size(); ++d)
    {
      const auto& to = model.SourceDirections()[d];
      const auto& from = model.Directions().directions[i].omega;
      const PublishedModel::Part part = model.Source(static_cast<int>(d));
      const double scattered = part.factor * model.Coefficient(part.moment, static_cast<int>(i));
      forward += scattered * (from[0] * to[0] + from[1] * to[1] + from[2] * to[2]);
      all += scattered;
    }
  }
  return forward / all;
}
}

TEST(PublishedModel, ScattersWhatItTakes)
{
  EvenMedium even({ { 1, 1, 1 } }, 0.0f, 1.0f);
  for (const PhaseFunction& function : ManyFunctions())
  {
    even.medium.phase = function;
    PropagationSettings settings;
    settings.storedDirections = 6; // all of the same size
    const PublishedModel model(even.medium, {}, settings);
    for (std::size_t i = 0; i < model.Directions().directions.size(); ++i)
    {
      double scattered = 0.0;
      for (int d = 0; d < 6; ++d)
      {
        const PublishedModel::Part part = model.Source(d);
        scattered += 4.0 * Pi / 6.0 * part.factor * model.Coefficient(part.moment, static_cast<int>(i));
      }
      EXPECT_NEAR(scattered, model.Directions().directions[i].weight, 2e-3 * scattered) << function.MeanCosine();
    }
  }
}

TEST(PublishedModel, ScattersAlongTheMeanCosine)
{
  EvenMedium even({ { 1, 1, 1 } }, 0.0f, 1.0f);
  PropagationSettings settings;
  settings.storedDirections = 150;
  for (const PhaseFunction& function : ManyFunctions())
  {
    even.medium.phase = function;
    const double g = function.MeanCosine();
    EXPECT_NEAR(MeanCosineOf(PublishedModel(even.medium, {}, settings)), g, 0.02 * std::max(std::abs(g), 0.5)) << g;
  }
}

// Cells of a face hold all directions that are propagated through it.
TEST(PublishedModel, KeepsAPeakThatIsNarrowerThanACell)
{
  EvenMedium even({ { 1, 1, 1 } }, 0.0f, 1.0f);
  even.medium.phase = PhaseFunction::HenyeyGreenstein(0.9999);
  PropagationSettings settings;
  settings.storedDirections = 6;
  const PublishedModel model(even.medium, {}, settings);
  for (int i = 0; i < 150; ++i)
  {
    double kept = 0.0, all = 0.0;
    for (int d = 0; d < 6; ++d)
    {
      const PublishedModel::Part part = model.Source(d);
      const double scattered = part.factor * model.Coefficient(part.moment, i);
      kept += d == model.SourceOf(i) ? scattered : 0.0;
      all += scattered;
    }
    EXPECT_GT(kept / all, 0.98) << i;
  }
}

TEST(PublishedModel, HasOnePhaseFunction)
{
  EvenMedium even({ { 2, 1, 1 } }, 0.0f, 1.0f);
  const std::vector<float> g = { 0.1f, 0.2f };
  even.medium.phase = PhaseOfMedium(PhaseFunction::HenyeyGreenstein(0.0), Field{ g.data() });
  EXPECT_THROW(PublishedModel(even.medium, {}, {}), InvalidInput);
  EXPECT_THROW(SolveSequential(even.medium, {}, {}), InvalidInput);
  even.medium.phase = PhaseOfMedium(std::array<PhaseFunction, 3>{
    PhaseFunction::HenyeyGreenstein(0.1), PhaseFunction::HenyeyGreenstein(0.1), PhaseFunction::HenyeyGreenstein(0.2) });
  EXPECT_THROW(PublishedModel(even.medium, {}, {}), InvalidInput);
  EXPECT_THROW(SolveSequential(even.medium, {}, {}), InvalidInput);
}

TEST(PublishedModel, HasNoFacesThatReflect)
{
  EvenMedium even({ { 2, 1, 1 } }, 0.1f, 1.0f);
  Illumination reflected;
  reflected.faceAlbedo[2] = { 0.0, 0.5, 0.0 };
  const std::string remedy = "set FaceAlbedo to 0";
  EXPECT_THAT([&] { PublishedModel(even.medium, reflected, {}); },
    testing::ThrowsMessage<InvalidInput>(testing::HasSubstr(remedy)));
  EXPECT_THAT([&] { SolveSequential(even.medium, reflected, {}); },
    testing::ThrowsMessage<InvalidInput>(testing::HasSubstr(remedy)));
  EXPECT_NE(WhyNotPublished(even.medium, reflected), "");
  EXPECT_EQ(WhyNotPublished(even.medium, {}), "");
}

TEST(PublishedModel, IsotropicScatteringIsTheSameIntoAllDirections)
{
  EvenMedium even({ { 1, 1, 1 } }, 0.0f, 1.0f);
  const PublishedModel model(even.medium, {}, {});
  EXPECT_EQ(model.StoredDirections().size(), 1u);
  EXPECT_EQ(model.SourceDirections().size(), 6u);
  EXPECT_EQ(model.MomentCount(), 1);
  EXPECT_DOUBLE_EQ(model.Source(3).factor, 1.0 / (4.0 * Pi));
  for (int i = 0; i < 150; ++i)
  {
    EXPECT_EQ(model.SourceOf(i), i / 25); // the face that it points through
  }
}

TEST(PublishedModel, KeepsThePowerOfTheSun)
{
  EvenMedium even({ { 1, 1, 1 } }, 0.0f, 1.0f);
  Illumination sun;
  sun.lights.push_back({});
  sun.lights[0].direction = { 0.3, -0.5, -2.0 };
  sun.lights[0].power = { 7.0, 5.0, 3.0 };
  const PublishedModel model(even.medium, sun, {});
  EXPECT_EQ(model.Channels(), 3);
  double irradiance = 0.0;
  for (int i = 0; i < 150; ++i)
  {
    irradiance += model.Boundary(i, 2)[1] * model.Directions().directions[i].weight;
  }
  EXPECT_NEAR(irradiance, 5.0, 1e-12);
}

TEST(PublishedModel, LightsAFaceFromOutsideOnly)
{
  EvenMedium even({ { 1, 1, 1 } }, 0.0f, 1.0f);
  Illumination left;
  left.faces[0] = { 1.0, 1.0, 1.0 };
  const PublishedModel model(even.medium, left, {});
  for (int i = 0; i < 150; ++i)
  {
    const double x = model.Directions().directions[i].omega[0];
    EXPECT_EQ(model.Boundary(i, 0)[0], x >= 0.0 ? 1.0 : 0.0);
    EXPECT_EQ(model.Boundary(i, 1)[0], 0.0);
  }
}

TEST(PublishedModel, SaysWhichLightsDoNotShine)
{
  Illumination lamp;
  lamp.lights.push_back({});
  EXPECT_TRUE(LeftOutAsPublished(lamp).empty());
  lamp.lights[0].type = LightType::Point;
  ASSERT_EQ(LeftOutAsPublished(lamp).size(), 1u);
}

TEST(PublishedModel, RefusesSettingsWithoutMeaning)
{
  EvenMedium even({ { 1, 1, 1 } }, 0.0f, 1.0f);
  const auto with = [&](auto change) {
    PropagationSettings settings;
    change(settings);
    PublishedModel(even.medium, {}, settings);
  };
  EXPECT_THROW(with([](auto& s) { s.directionsPerFace = 24; }), InvalidInput);
  EXPECT_THROW(with([](auto& s) { s.mapResolution = 0; }), InvalidInput);
  EXPECT_THROW(with([](auto& s) { s.maximumOrders = -1; }), InvalidInput);
  EXPECT_THROW(with([](auto& s) { s.storedDirections = 0; }), InvalidInput);
  EXPECT_THROW(with([](auto& s) { s.tolerance = NAN; }), InvalidInput);
}
