#include "ErrorWords.h"
#include "RectangleSeen.h"

#include "Device/Errors.h"
#include "Numerics/Constants.h"
#include "Photons/Emission/PhotonEmitter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace tyndall;

namespace
{
Grid Box()
{
  Grid grid;
  grid.size = { 8, 10, 12 };
  grid.spacing = { 0.25, 0.3, 0.5 }; // 2 x 3 x 6
  grid.origin = { -1.0, 1.0, 2.0 };
  return grid;
}

Light Lamp(LightType type, std::array<double, 3> position, std::array<double, 3> direction = { 0.0, 0.0, -1.0 })
{
  Light lamp;
  lamp.type = type;
  lamp.position = position;
  lamp.direction = direction;
  lamp.power = { 10.0, 5.0, 2.0 };
  lamp.angle = 40.0;
  lamp.size = { 1.5, 0.5 };
  return lamp;
}

EmittedPhotons Emit(const Light& lamp, std::size_t count, Sampler sampler = Sampler::Hammersley, std::uint64_t seed = 0)
{
  Illumination light;
  light.lights = { lamp };
  return EmitPhotons(Box(), light, { count, sampler, seed });
}

/// Part of a point lamp's light that meets the box, by brute force.
double PartThatHits(const std::array<double, 3>& lamp)
{
  const Grid grid = Box();
  const int n = 1000;
  int hits = 0;
  for (int i = 0; i < n * n; ++i)
  {
    const double z = 1.0 - 2.0 * (i / n + 0.5) / n, turn = 2.0 * Pi * (i % n + 0.5) / n;
    const double d[3] = { std::sqrt(1.0 - z * z) * std::cos(turn), std::sqrt(1.0 - z * z) * std::sin(turn), z };
    double enter = 0.0, leave = 1e9;
    for (int a = 0; a < 3; ++a)
    {
      const double t0 = (grid.origin[a] - lamp[a]) / d[a];
      const double t1 = (grid.origin[a] + grid.size[a] * grid.spacing[a] - lamp[a]) / d[a];
      enter = std::max(enter, std::min(t0, t1));
      leave = std::min(leave, std::max(t0, t1));
    }
    hits += enter < leave;
  }
  return static_cast<double>(hits) / (n * n);
}

bool OnBox(const Photon& photon)
{
  const Grid grid = Box();
  bool onFace = false;
  for (int a = 0; a < 3; ++a)
  {
    const double low = photon.position[a] - grid.origin[a];
    const double high = grid.size[a] * grid.spacing[a] - low;
    if (std::min(low, high) < -1e-9)
    {
      return false;
    }
    onFace = onFace || std::min(low, high) < 1e-9;
  }
  return onFace;
}

/// Whether photons go into the box: all but the first sample of a sequence, which may meet a corner of it.
bool AllGoIn(const std::vector<Photon>& photons)
{
  const Grid grid = Box();
  const auto goesOut = [&](const Photon& photon) {
    bool out = !OnBox(photon);
    for (int a = 0; a < 3; ++a)
    {
      const double low = photon.position[a] - grid.origin[a];
      const double high = grid.Length(a) - low;
      out = out || (low < 1e-9 && photon.direction[a] < 0.0f) || (high < 1e-9 && photon.direction[a] > 0.0f);
    }
    return out;
  };
  return std::count_if(photons.begin(), photons.end(), goesOut) <= 1;
}
}

TEST(PhotonEmitter, ADirectionalLightGivesItsIrradianceTimesTheOutline)
{
  for (const std::array<double, 3>& direction :
    { std::array<double, 3>{ 0.0, 0.0, -1.0 }, { 1.0, 0.0, 0.0 }, { 0.3, -0.4, 0.7 }, { -5.0, 1.0, 0.01 } })
  {
    const EmittedPhotons emitted = Emit(Lamp(LightType::Directional, {}, direction), 3001);
    EXPECT_EQ(emitted.photons.size(), 3001u);
    EXPECT_TRUE(std::all_of(emitted.photons.begin(), emitted.photons.end(), OnBox));
    const double length = std::hypot(direction[0], direction[1], direction[2]);
    const double outline =
      (std::abs(direction[0]) * 18.0 + std::abs(direction[1]) * 12.0 + std::abs(direction[2]) * 6.0) / length;
    EXPECT_NEAR(emitted.power[0], 10.0 * outline, 1e-4 * outline);
    EXPECT_NEAR(emitted.power[2], 2.0 * outline, 1e-4 * outline);
  }
}

TEST(PhotonEmitter, AFaceSeenSquarelyIsLitWhollyWhereverTheBoxIs)
{
  const double tilt = std::cos(0.5 * Pi); // 6e-17: a sun straight above
  for (double corner : { 0.0, -2.0, 1.0, 1e6 })
  {
    for (const std::array<double, 3>& direction : { std::array<double, 3>{ 0.0, 0.0, -1.0 }, { tilt, tilt, -1.0 },
           { -tilt, tilt, -1.0 }, { tilt, -tilt, -1.0 }, { -1.0, tilt, -tilt }, { tilt, 1.0, tilt } })
    {
      Grid grid;
      grid.size = { 4, 4, 4 };
      grid.origin = { corner, corner, corner };
      Illumination light;
      light.lights.push_back(Lamp(LightType::Directional, {}, direction));
      const EmittedPhotons emitted = EmitPhotons(grid, light, { 1000 });
      EXPECT_NEAR(emitted.power[0], 16.0 * 10.0, 1e-3) << corner << " " << direction[0] << " " << direction[1];
      int quarters[4] = {};
      for (const Photon& photon : emitted.photons)
      {
        const int a = std::abs(direction[0]) > 0.5 ? 1 : 0, b = std::abs(direction[2]) > 0.5 ? 1 : 2;
        ++quarters[2 * (photon.position[a] > corner + 2.0) + (photon.position[b] > corner + 2.0)];
      }
      for (int quarter : quarters)
      {
        EXPECT_NEAR(quarter, 250, 10) << corner << " " << direction[0] << " " << direction[1];
      }
    }
  }
}

TEST(PhotonEmitter, PhotonsOfADirectionalLightAreSpreadEvenly)
{
  // What enters through each face is its part of the outline.
  const EmittedPhotons emitted = Emit(Lamp(LightType::Directional, {}, { 1.0, 1.0, 1.0 }), 10000);
  double x = 0.0, y = 0.0;
  for (const Photon& photon : emitted.photons)
  {
    x += std::abs(photon.position[0] + 1.0) < 1e-9 ? 1e-4 : 0.0;
    y += std::abs(photon.position[1] - 1.0) < 1e-9 ? 1e-4 : 0.0;
  }
  EXPECT_NEAR(x, 18.0 / 36.0, 2e-3);
  EXPECT_NEAR(y, 12.0 / 36.0, 2e-3);
}

TEST(PhotonEmitter, APointOutsideGivesTheSolidAngleOfTheBox)
{
  for (const std::array<double, 3>& place :
    { std::array<double, 3>{ 0.0, 2.0, 9.0 }, { 3.0, 5.5, 9.0 }, { -1.3, 0.7, 4.0 }, { 4.0, 2.0, 3.0 } })
  {
    const EmittedPhotons emitted = Emit(Lamp(LightType::Point, place), 2000);
    EXPECT_EQ(emitted.photons.size(), 2000u);
    EXPECT_TRUE(std::all_of(emitted.photons.begin(), emitted.photons.end(), OnBox));
    EXPECT_NEAR(emitted.power[0] / (10.0 * PartThatHits(place)), 1.0, 0.01);
    for (const Photon& photon : emitted.photons)
    {
      ASSERT_FLOAT_EQ(photon.power[0], emitted.photons[0].power[0]);
    }
  }
}

TEST(PhotonEmitter, APointFarAwayIsADirectionalLight)
{
  for (double far : { 1e6, 1e7, 1e13 })
  {
    const EmittedPhotons emitted = Emit(Lamp(LightType::Point, { 0.0, 2.5, far }), 1000);
    EXPECT_NEAR(emitted.power[0] / (10.0 * 6.0 / (4.0 * Pi * far * far)), 1.0, 1e-4) << far;
  }
}

TEST(PhotonEmitter, DirectionsMayHaveAnyLength)
{
  for (LightType type : { LightType::Directional, LightType::Spot, LightType::Rectangle })
  {
    const EmittedPhotons expected = Emit(Lamp(type, { 0.0, 2.5, 9.0 }, { 0.1, 0.2, -1.0 }), 100);
    for (double length : { 1e-300, 1e-165, 1e160 })
    {
      const EmittedPhotons emitted = Emit(Lamp(type, { 0.0, 2.5, 9.0 }, { 0.1 * length, 0.2 * length, -length }), 100);
      ASSERT_EQ(emitted.photons.size(), expected.photons.size()) << length;
      EXPECT_FLOAT_EQ(emitted.power[0], expected.power[0]);
      EXPECT_FLOAT_EQ(emitted.photons[0].direction[2], expected.photons[0].direction[2]);
    }
  }
}

TEST(PhotonEmitter, LampsInsideGiveAllTheirPower)
{
  for (LightType type : { LightType::Point, LightType::Spot, LightType::Rectangle })
  {
    const EmittedPhotons emitted = Emit(Lamp(type, { 0.0, 2.5, 5.0 }), 1500);
    EXPECT_EQ(emitted.photons.size(), 1500u);
    EXPECT_NEAR(emitted.power[0], 10.0, 1e-3);
    double along = 0.0;
    for (const Photon& photon : emitted.photons)
    {
      along -= photon.direction[2] / 1500.0;
    }
    // Mean cosine: of a sphere, a cone of 20 degrees, a Lambertian half-space.
    const double expected = type == LightType::Point ? 0.0
      : type == LightType::Spot                      ? 0.5 * (1.0 + std::cos(Pi / 9.0))
                                                     : 2.0 / 3.0;
    EXPECT_NEAR(along, expected, 2e-3);
  }
}

TEST(PhotonEmitter, ALampOnAFaceGivesWhatItShinesIntoTheBox)
{
  const std::pair<std::array<double, 3>, double> places[] = { { { 0.0, 2.5, 8.0 }, 0.5 }, { { -1.0, 2.5, 5.0 }, 0.5 },
    { { 0.0, 4.0, 5.0 }, 0.5 }, { { 1.0, 2.5, 8.0 }, 0.25 }, { { -1.0, 1.0, 3.0 }, 0.25 }, { { 0.2, 1.0, 8.0 }, 0.25 },
    { { 1.0, 4.0, 8.0 }, 0.125 }, { { -1.0, 4.0, 2.0 }, 0.125 } };
  for (const auto& [place, part] : places)
  {
    // On the face, rounded off it to either side, and a little outside.
    for (double away : { 0.0, -1e-12, 1e-12, 1e-7, 1e-4 })
    {
      std::array<double, 3> lamp = place;
      for (int a = 0; a < 3; ++a)
      {
        const double low = Box().origin[a], high = low + Box().Length(a);
        lamp[a] += place[a] == low ? -away : place[a] == high ? away : 0.0;
      }
      const EmittedPhotons emitted = Emit(Lamp(LightType::Point, lamp), 4000);
      EXPECT_EQ(emitted.photons.size(), 4000u);
      EXPECT_NEAR(emitted.power[0], 10.0 * part, 1e-3 + 2.0 * std::abs(away)) << away << " off " << place[2];
      EXPECT_TRUE(AllGoIn(emitted.photons)) << away << " off " << place[2];
    }
  }
}

TEST(PhotonEmitter, LightOfALampOnAFaceIsSpreadBySolidAngle)
{
  // Mean direction: half of a sphere (0, 0, -1/2), a quarter twice that, an eighth thrice.
  const std::pair<std::array<double, 3>, std::array<double, 3>> places[] = { { { 0.0, 2.5, 8.0 }, { 0.0, 0.0, -0.5 } },
    { { -1.0, 2.5, 8.0 }, { 0.5, 0.0, -0.5 } }, { { -1.0, 1.0, 8.0 }, { 0.5, 0.5, -0.5 } } };
  for (const auto& [place, expected] : places)
  {
    std::array<double, 3> mean = {};
    for (const Photon& photon : Emit(Lamp(LightType::Point, place), 5000).photons)
    {
      for (int a = 0; a < 3; ++a)
      {
        mean[a] += photon.direction[a] / 5000.0;
      }
    }
    for (int a = 0; a < 3; ++a)
    {
      EXPECT_NEAR(mean[a], expected[a], 2e-3) << place[0] << ", axis " << a;
    }
  }
}

TEST(PhotonEmitter, SpotsOnAFaceGiveWhatTheyShineIntoTheBox)
{
  const auto power = [](const std::array<double, 3>& place, const std::array<double, 3>& direction, double angle) {
    Light spot = Lamp(LightType::Spot, place, direction);
    spot.angle = angle;
    const EmittedPhotons emitted = Emit(spot, 4000);
    EXPECT_TRUE(AllGoIn(emitted.photons));
    return emitted.power[0];
  };
  EXPECT_NEAR(power({ 0.0, 2.5, 8.0 }, { 0.0, 0.0, -1.0 }, 40.0), 10.0, 1e-3);
  EXPECT_NEAR(power({ 0.0, 2.5, 8.0 }, { 0.0, 0.0, -1.0 }, 180.0), 10.0, 1e-3);
  EXPECT_EQ(power({ 0.0, 2.5, 8.0 }, { 0.0, 0.0, 1.0 }, 40.0), 0.0);
  EXPECT_NEAR(power({ 0.0, 2.5, 8.0 }, { 1.0, 0.0, 0.0 }, 40.0), 5.0, 0.05); // along the face
  EXPECT_NEAR(
    power({ 1.0, 4.0, 8.0 }, { -1.0, -1.0, -1.0 }, 180.0), 2.5, 0.025); // an eighth of the half it shines into
  for (double away : { 1e-9, 1e-5, 1e-4 })
  {
    EXPECT_NEAR(power({ 0.0, 2.5, 8.0 + away }, { 1.0, 0.0, -0.2 }, 40.0),
      power({ 0.0, 2.5, 8.0 }, { 1.0, 0.0, -0.2 }, 40.0), 0.05);
  }
}

TEST(PhotonEmitter, RectanglesOnAFaceGiveWhatTheyShineIntoTheBox)
{
  const auto power = [](const std::array<double, 3>& place, const std::array<double, 3>& direction) {
    const EmittedPhotons emitted = Emit(Lamp(LightType::Rectangle, place, direction), 4000);
    EXPECT_TRUE(AllGoIn(emitted.photons));
    return emitted.power[0];
  };
  EXPECT_NEAR(power({ 0.0, 2.5, 8.0 }, { 0.0, 0.0, -1.0 }), 10.0, 1e-3);
  EXPECT_NEAR(power({ 0.0, 2.5, 8.0 + 1e-9 }, { 0.0, 0.0, -1.0 }), 10.0, 1e-3);
  EXPECT_EQ(power({ 0.0, 2.5, 8.0 }, { 0.0, 0.0, 1.0 }), 0.0);
  EXPECT_NEAR(power({ -1.0, 2.5, 5.0 }, { 1.0, 0.0, 0.0 }), 10.0, 1e-3);
  // Half of it sticks out over an edge, and lights the box over the other face a little.
  EXPECT_NEAR(power({ 1.0, 2.5, 8.0 }, { 0.0, 0.0, -1.0 }), power({ 1.0, 2.5, 8.0 + 1e-4 }, { 0.0, 0.0, -1.0 }), 0.03);
}

TEST(PhotonEmitter, TooManyPhotonsAreRefusedAtOnce)
{
  for (std::size_t count : { std::size_t(1000000000000), std::size_t(1) << 62 })
  {
    const std::string text = ErrorWords<DeviceError>([&] { Emit(Lamp(LightType::Point, { 0.0, 2.5, 5.0 }), count); });
    EXPECT_NE(text.find(std::to_string(count) + " photons"), std::string::npos) << text;
    EXPECT_NE(text.find("bytes each"), std::string::npos) << text;
    EXPECT_NE(text.find("Ask for fewer photons"), std::string::npos) << text;
  }
}

TEST(PhotonEmitter, ASpotThatLightsTheBoxWhollyGivesAllItsPower)
{
  Light narrow = Lamp(LightType::Spot, { 0.0, 2.5, 12.0 });
  narrow.angle = 8.0;
  EXPECT_NEAR(Emit(narrow, 1000).power[0], 10.0, 1e-3);
  for (double angle : { 1e-12, 1e-6, 1e-3 })
  {
    narrow.angle = angle;
    narrow.direction = { 0.02, 0.03, -1.0 };
    const EmittedPhotons emitted = Emit(narrow, 1000);
    EXPECT_NEAR(emitted.power[0], 10.0, 1e-3) << angle;
    for (const Photon& photon : emitted.photons) // the cone's radius at the face is 4 tan(angle / 2)
    {
      const double offset = std::hypot(photon.position[0] - 0.08, photon.position[1] - 2.62);
      ASSERT_LE(offset, 4.1 * std::tan(0.5 * angle * Pi / 180.0) + 1e-13) << angle;
    }
  }
  Light wide = Lamp(LightType::Spot, { 0.0, 2.5, 12.0 });
  wide.angle = 170.0;
  const double cone = 2.0 * Pi * (1.0 - std::cos(85.0 * Pi / 180.0));
  EXPECT_NEAR(Emit(wide, 1000).power[0] / (10.0 * PartThatHits({ 0.0, 2.5, 12.0 }) * 4.0 * Pi / cone), 1.0, 0.01);
  Light half = Lamp(LightType::Spot, { 0.0, 2.5, 12.0 }, { 0.2, 0.0, -1.0 });
  half.angle = 20.0;
  const EmittedPhotons emitted = Emit(half, 5000);
  EXPECT_NEAR(static_cast<double>(emitted.photons.size()), 5000.0, 50.0);
  EXPECT_LT(emitted.power[0], 9.0);
}

TEST(PhotonEmitter, ARectangleFarAwayShinesByTheCosine)
{
  const double far = 1000.0;
  for (double tilt : { 0.0, 1.0 })
  {
    const EmittedPhotons emitted =
      Emit(Lamp(LightType::Rectangle, { 0.0, 2.5, 8.0 + far }, { 0.0, std::sin(tilt), -std::cos(tilt) }), 1000);
    EXPECT_NEAR(emitted.power[0] / (10.0 / Pi * std::cos(tilt) * 6.0 / (far * far)), 1.0, 0.02) << tilt;
  }
  EXPECT_EQ(Emit(Lamp(LightType::Rectangle, { 0.0, 2.5, 20.0 }, { 0.0, 0.0, 1.0 }), 100).photons.size(), 0u);
}

namespace
{
struct PlacedRectangle
{
  std::array<double, 3> position, direction;
  std::array<double, 2> size;
};

/// Of an edge given in lengths of the box: in front of it, beside it, askew, with its border over it, on a face,
/// through the box.
std::vector<PlacedRectangle> LargeRectangles(double edges)
{
  const double size = 6.0 * edges;
  return { { { 0.0, 2.5, 9.0 }, { 0.0, 0.0, -1.0 }, { size, size } },
    { { 0.0, 2.5, 60.0 }, { 0.0, 0.0, -1.0 }, { size, size } },
    { { 1.5, 3.0, 4.0 }, { -1.0, 0.0, 0.0 }, { size, size } },
    { { -3.0, 0.0, 10.0 }, { 0.4, 0.3, -1.0 }, { size, 0.7 * size } },
    { { 0.2 + 0.5 * size, 2.5, 9.0 }, { 0.0, 0.0, -1.0 }, { size, size } },
    { { 0.0, 2.5, 8.0 }, { 0.0, 0.0, -1.0 }, { size, size } },
    { { 0.0, 2.5, 8.0 + 1e-7 }, { 0.0, 0.0, -1.0 }, { size, size } },
    { { 0.1, 2.0, 5.0 }, { 0.3, -0.5, 0.7 }, { size, size } },
    { { 0.1, 2.0, 5.0 }, { 0.0, 1.0, 0.0 }, { size, size } } };
}

Light LampOf(const PlacedRectangle& rectangle)
{
  Light lamp = Lamp(LightType::Rectangle, rectangle.position, rectangle.direction);
  lamp.size = rectangle.size;
  return lamp;
}

/// Power over what enters, less 1, and the standard error that photons of independent samples would have.
std::pair<double, double> ErrorOf(const EmittedPhotons& emitted, double exact)
{
  double squares = 0.0;
  for (const Photon& photon : emitted.photons)
  {
    squares += std::pow(photon.power[0] / exact, 2.0);
  }
  return { emitted.power[0] / exact - 1.0, std::sqrt(squares) };
}
}

TEST(PhotonEmitter, OfALargeRectangleEntersWhatItShinesOntoTheBox)
{
  for (const double edges : { 10.0, 100.0, 1000.0, 1e5 })
  {
    for (const PlacedRectangle& rectangle : LargeRectangles(edges))
    {
      const Light lamp = LampOf(rectangle);
      const double exact = lamp.power[0] * RectangleSeen(lamp).PartThatEnters(Box(), 40);
      for (const Sampler sampler : { Sampler::Hammersley, edges == 10.0 ? Sampler::Random : Sampler::Halton })
      {
        const EmittedPhotons emitted = Emit(lamp, 20000, sampler, 5);
        const auto [error, deviation] = ErrorOf(emitted, exact);
        const std::string name = std::to_string(edges) + " boxes, at " + std::to_string(lamp.position[0]) + ' ' +
          std::to_string(lamp.position[2]) + ", sampler " + std::to_string(static_cast<int>(sampler));
        EXPECT_NEAR(static_cast<double>(emitted.photons.size()), 20000.0, 600.0) << name;
        EXPECT_LT(std::abs(error), std::min(3.0 * deviation, sampler == Sampler::Random ? 0.03 : 0.01)) << name;
        EXPECT_LT(deviation, 0.02) << name;
      }
    }
  }
}

TEST(PhotonEmitter, PhotonsOfALargeRectangleGoIntoTheBox)
{
  for (const PlacedRectangle& rectangle : LargeRectangles(1000.0))
  {
    const std::vector<Photon> photons = Emit(LampOf(rectangle), 2000).photons;
    const auto comesFromIt = [&](const Photon& photon) {
      glm::dvec3 from = Vector(photon.position) - Vector(rectangle.position);
      return glm::dot(from, Vector(rectangle.direction)) >= -1e-6 &&
        photon.direction[0] * rectangle.direction[0] + photon.direction[1] * rectangle.direction[1] +
          photon.direction[2] * rectangle.direction[2] >
        0.0;
    };
    EXPECT_TRUE(std::all_of(photons.begin(), photons.end(), comesFromIt));
  }
}

/// Thin ones, of up to 200 lengths of the box, near to it and far away.
TEST(PhotonEmitter, OfATubeEntersWhatItShinesOntoTheBox)
{
  for (const std::array<double, 2>& size : { std::array<double, 2>{ 1200.0, 0.5 }, { 0.05, 1200.0 }, { 12.0, 0.02 } })
  {
    for (const double height : { 8.02, 8.5, 11.0 })
    {
      const Light lamp = LampOf({ { 0.3, 2.5, height }, { 0.0, 0.0, -1.0 }, size });
      const double exact = lamp.power[0] * RectangleSeen(lamp).PartThatEnters(Box());
      const auto [error, deviation] = ErrorOf(Emit(lamp, 20000), exact);
      EXPECT_LT(std::abs(error), 3.0 * deviation + 1e-3) << size[0] << " at " << height;
      EXPECT_LT(deviation, 0.08) << size[0] << " at " << height;
    }
  }
}

TEST(PhotonEmitter, AnImportanceMapBiasesNoLargeRectangle)
{
  ImportanceMap map;
  map.size = 4;
  map.lights = { 0 };
  for (int cell = 0; cell < 16; ++cell)
  {
    map.density.push_back(cell % 5 == 0 ? 2.5f : 0.5f);
  }
  Illumination light;
  for (const PlacedRectangle& rectangle : LargeRectangles(1000.0))
  {
    light.lights = { LampOf(rectangle) };
    EmissionSettings settings;
    settings.photonCount = 20000;
    settings.map = &map;
    const double exact = 10.0 * RectangleSeen(light.lights[0]).PartThatEnters(Box(), 40);
    const auto [error, deviation] = ErrorOf(EmitPhotons(Box(), light, settings), exact);
    EXPECT_LT(std::abs(error), std::min(3.0 * deviation, 0.015)) << rectangle.position[2];
    EXPECT_EQ(EmitPilots(Box(), light, 16)[0].light, 0);
  }
}

TEST(PhotonEmitter, ADirectionalLightGivesAllItsPowerByImportance)
{
  ImportanceMap map;
  map.size = 4;
  map.lights = { 0 };
  map.density.assign(16, 0.4f);
  map.density[5] = 10.0f; // from which few photons come where they are dense at most
  EmissionSettings settings;
  settings.photonCount = 3001;
  settings.map = &map;
  for (settings.batches = 1; settings.batches <= 3; settings.batches += 2)
  {
    Illumination light;
    light.lights = { Lamp(LightType::Directional, {}) };
    EXPECT_NEAR(EmitPhotons(Box(), light, settings).power[0], 10.0 * 6.0, 1e-4) << settings.batches;
  }
}

TEST(PhotonEmitter, AnEvenSkyGivesItsRadianceTimesPiTimesTheSurface)
{
  Illumination light;
  light.sky = { 1.0, 2.0, 3.0 };
  const EmittedPhotons sky = EmitPhotons(Box(), light, { 20000 });
  EXPECT_EQ(sky.photons.size(), 20000u);
  EXPECT_NEAR(sky.power[1] / (2.0 * Pi * 72.0), 1.0, 1e-3);
  EXPECT_EQ(sky.lights[0], -1);

  light.sky = {};
  light.faces.fill({ 1.0, 2.0, 3.0 });
  EXPECT_NEAR(EmitPhotons(Box(), light, { 20000 }).power[1] / (2.0 * Pi * 72.0), 1.0, 1e-3);
}

TEST(PhotonEmitter, APeakInTheSkyIsSeenAndWeighedRight)
{
  Illumination light;
  light.environment.width = 32;
  light.environment.height = 16;
  light.environment.radiance.assign(3 * 32 * 16, 0.0f);
  light.environment.radiance[3 * (11 * 32 + 5)] = 100.0f;
  double exact = 0.0; // of the bilinear picture
  const int n = 2000;
  for (int i = 0; i < n * n; ++i)
  {
    const double z = -1.0 + 2.0 * (i / n + 0.5) / n, turn = 2.0 * Pi * (i % n + 0.5) / n;
    const std::array<double, 3> seen = { std::sqrt(1.0 - z * z) * std::cos(turn),
      std::sqrt(1.0 - z * z) * std::sin(turn), z };
    const double outline = 18.0 * std::abs(seen[0]) + 12.0 * std::abs(seen[1]) + 6.0 * std::abs(seen[2]);
    exact += Lookup(light.environment, seen)[0] * outline * 4.0 * Pi / (n * n);
  }
  for (Sampler sampler : { Sampler::Hammersley, Sampler::Halton, Sampler::Jittered, Sampler::Grid, Sampler::Random })
  {
    EXPECT_NEAR(EmitPhotons(Box(), light, { 20000, sampler, 3 }).power[0] / exact, 1.0, 0.015);
  }
}

TEST(PhotonEmitter, ASkyHasItsPowerHoweverItStands)
{
  Illumination light;
  light.environment.width = 64;
  light.environment.height = 32;
  light.environment.radiance.assign(3 * 64 * 32, 0.5f);
  light.environment.radiance[3 * (31 * 64 + 5)] = 2e4f; // a pixel at the zenith
  const Grid cube{ { 4, 4, 4 } };                       // it looks alike from all sides of another axis
  const double upright = EmitPhotons(cube, light, { 20000 }).power[0];
  for (int up = 0; up < 2; ++up)
  {
    Illumination turned = light;
    turned.environment = Turned(light.environment, up, 0.0);
    const EmittedPhotons emitted = EmitPhotons(cube, turned, { 20000 });
    EXPECT_NEAR(emitted.power[0] / upright, 1.0, 1e-3);
    std::array<double, 3> along = {};
    for (const Photon& photon : emitted.photons)
    {
      for (int a = 0; a < 3; ++a)
      {
        along[a] -= photon.direction[a] * photon.power[0];
      }
    }
    EXPECT_GT(along[up], 10.0 * std::abs(along[2]));
  }
}

TEST(PhotonEmitter, LightsShareThePhotonsByPower)
{
  Illumination light;
  light.lights = { Lamp(LightType::Point, { 0.0, 2.5, 5.0 }), Lamp(LightType::Point, { 0.0, 2.5, 4.0 }) };
  light.lights[1].power = { 30.0, 15.0, 6.0 };
  light.lights.push_back(light.lights[0]);
  light.lights[2].power = { 1e-9, 0.0, 0.0 };
  light.lights.push_back(light.lights[0]);
  light.lights[3].power = { 0.0, 0.0, 0.0 };
  const EmittedPhotons emitted = EmitPhotons(Box(), light, { 4000 });
  EXPECT_NEAR(std::count(emitted.lights.begin(), emitted.lights.end(), 1), 3000, 2);
  EXPECT_EQ(std::count(emitted.lights.begin(), emitted.lights.end(), 2), 1);
  EXPECT_EQ(std::count(emitted.lights.begin(), emitted.lights.end(), 3), 0);
  EXPECT_NEAR(emitted.power[0], 40.0, 1e-3);
}

TEST(PhotonEmitter, IsTheSameForTheSameSeed)
{
  for (Sampler sampler : { Sampler::Hammersley, Sampler::Halton, Sampler::Jittered, Sampler::Grid, Sampler::Random })
  {
    const Light sun = Lamp(LightType::Directional, {}, { 0.1, 0.2, -1.0 });
    const auto place = [&](std::uint64_t seed) { return Emit(sun, 100, sampler, seed).photons[42].position; };
    EXPECT_EQ(place(7), place(7));
    EXPECT_NE(place(7), place(8));
  }
}

TEST(PhotonEmitter, RefusesNoPhotonsAndBadLights)
{
  EXPECT_THROW(Emit(Lamp(LightType::Point, { 0.0, 0.0, 0.0 }), 0), InvalidInput);
  Light bad = Lamp(LightType::Spot, { 0.0, 0.0, 0.0 });
  bad.angle = 0.0;
  EXPECT_THROW(Emit(bad, 10), InvalidInput);
}

TEST(SampleSequence, CellsHaveOnePointEachForAnyCount)
{
  for (std::size_t count : { 1u, 2u, 7u, 100u, 1000u, 1013u })
  {
    const SampleSequence grid(Sampler::Grid, count);
    std::set<std::array<double, 2>> first, second;
    double mean = 0.0;
    for (std::size_t i = 0; i < count; ++i)
    {
      const std::array<double, 4> u = grid[i];
      first.insert({ u[0], u[1] });
      second.insert({ u[2], u[3] });
      mean += u[0] / count;
      EXPECT_TRUE(std::all_of(u.begin(), u.end(), [](double x) { return x >= 0.0 && x < 1.0; }));
    }
    EXPECT_EQ(first.size(), count);
    EXPECT_EQ(second.size(), count);
    EXPECT_NEAR(mean, 0.5, 1e-9);
  }
}

/// Parts, one after the other, are all photons in their order.
TEST(PhotonEmitter, PartsOfThePhotonsAreAllOfThem)
{
  const Grid grid = Box();
  Illumination light;
  light.sky = { 1.0, 0.5, 0.2 };
  light.lights = { Lamp(LightType::Directional, {}), Lamp(LightType::Spot, { 0.0, 2.5, 12.0 }) };
  for (const Sampler sampler : { Sampler::Hammersley, Sampler::Jittered, Sampler::Random })
  {
    EmissionSettings settings;
    settings.photonCount = 100;
    settings.sampler = sampler;
    settings.batches = 3;
    const EmittedPhotons all = EmitPhotons(grid, light, settings);
    for (const int parts : { 1, 2, 7, 150 })
    {
      settings.parts = parts;
      std::size_t made = 0;
      for (settings.part = 0; settings.part < parts; ++settings.part)
      {
        const EmittedPhotons some = EmitPhotons(grid, light, settings);
        for (std::size_t i = 0; i < some.photons.size(); ++i, ++made)
        {
          ASSERT_LT(made, all.photons.size());
          ASSERT_EQ(some.photons[i].position, all.photons[made].position) << parts << " parts, photon " << made;
          ASSERT_EQ(some.photons[i].power, all.photons[made].power);
          ASSERT_EQ(some.photons[i].batch, all.photons[made].batch);
          ASSERT_EQ(some.lights[i], all.lights[made]);
        }
      }
      EXPECT_EQ(made, all.photons.size()) << parts << " parts";
      settings.part = 0;
    }
    settings.parts = 1;
  }
}
