#include "LightPropagation/Published/PublishedModel.h"
#include "RandomMedium.h"

#include "Device/Errors.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace tyndall;

namespace
{
const double Pi = std::acos(-1.0);
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

TEST(PublishedModel, ScattersWhatItTakes)
{
  EvenMedium even({ { 1, 1, 1 } }, 0.0f, 1.0f);
  for (const double g : { -0.5, 0.3, 0.9, 0.99 })
  {
    even.medium.phase = PhaseFunction::HenyeyGreenstein(g);
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
      EXPECT_NEAR(scattered, model.Directions().directions[i].weight, 2e-3 * scattered) << g;
    }
  }
}

TEST(PublishedModel, ScattersAlongTheMeanCosine)
{
  EvenMedium even({ { 1, 1, 1 } }, 0.0f, 1.0f);
  even.medium.phase = PhaseFunction::HenyeyGreenstein(0.6);
  PropagationSettings settings;
  settings.storedDirections = 150;
  const PublishedModel model(even.medium, {}, settings);
  double forward = 0.0;
  double all = 0.0;
  for (int i = 0; i < 150; ++i)
  {
    for (int d = 0; d < 150; ++d)
    {
      const auto& to = model.SourceDirections()[d];
      const auto& from = model.Directions().directions[i].omega;
      const PublishedModel::Part part = model.Source(d);
      const double scattered = part.factor * model.Coefficient(part.moment, i);
      forward += scattered * (from[0] * to[0] + from[1] * to[1] + from[2] * to[2]);
      all += scattered;
    }
  }
  EXPECT_NEAR(forward / all, 0.6, 0.02);
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
