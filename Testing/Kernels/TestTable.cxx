#include "ViewScene.h"

using namespace tyndall;
using namespace viewing;

namespace
{
class Table : public DeviceTest
{
};

/// Nothing above a table that is lit evenly by light of one direction.
Scene LitTable(double fluence, Vec direction)
{
  Scene scene(GridOf(24, 20, 16));
  scene.settings.imageSize = { 9, 7 };
  scene.settings.tableFace = 4;
  scene.settings.tableColor = { 0.2, 0.4, 0.8 };
  scene.settings.tableReflectance = 0.0;
  scene.fluence = scene.Everywhere(fluence);
  for (std::size_t voxel = 0; voxel < scene.grid.VoxelCount(); ++voxel)
  {
    for (const double c : direction)
    {
      scene.meanDirection.push_back(static_cast<float>(c));
    }
  }
  return scene;
}

void ExpectColour(const Scene& scene, const Picture& picture, double white)
{
  for (int c = 0; c < 3; ++c)
  {
    EXPECT_NEAR(scene.settings.tableColor[c] * white, picture.radiance[3 * Middle(picture) + c], 2e-5 * white);
  }
}

TEST_F(Table, ShinesAsItsIrradianceSays)
{
  const double slope = 0.6;
  const Camera oblique = Along(GridOf(24, 20, 16), { 0.3, 0.2, -1.0 }, 2.0);
  const Scene vertical = LitTable(5.0, { 0.0, 0.0, -1.0 });
  ExpectColour(vertical, vertical.Seen(this->GetDevice(), oblique), 5.0 / Pi);
  const Scene inclined = LitTable(5.0, { std::sin(slope), 0.0, -std::cos(slope) });
  ExpectColour(inclined, inclined.Seen(this->GetDevice(), oblique), 5.0 * std::cos(slope) / Pi);
  const Scene fromBelow = LitTable(5.0, { 0.0, 0.0, 1.0 });
  ExpectColour(fromBelow, fromBelow.Seen(this->GetDevice(), oblique), 0.0);
  Scene unknown = LitTable(5.0, {});
  unknown.meanDirection.clear();
  ExpectColour(unknown, unknown.Seen(this->GetDevice(), oblique), 5.0 / (4.0 * Pi));
}

TEST_F(Table, UnderASkyIsLitByOneBeamAndEvenLight)
{
  const double share = 0.3; // of the beam
  Scene scene = LitTable(5.0, { 0.0, 0.0, -share });
  const Camera oblique = Along(scene.grid, { 0.3, 0.2, -1.0 }, 2.0);
  ExpectColour(scene, scene.Seen(this->GetDevice(), oblique), 5.0 * share / Pi);
  scene.illumination.sky = { 1e-9, 1e-9, 1e-9 };
  ExpectColour(scene, scene.Seen(this->GetDevice(), oblique), 5.0 * ((1.0 - share) / 4.0 + share) / Pi);
  Scene even = LitTable(5.0, {});
  even.illumination.sky = { 1e-9, 1e-9, 1e-9 };
  ExpectColour(even, even.Seen(this->GetDevice(), oblique), 5.0 / (4.0 * Pi));
}

TEST_F(Table, WithoutLightIsDoubted)
{
  Scene scene = LitTable(5.0, { 0.0, 0.0, -1.0 });
  EXPECT_TRUE(scene.Caster(this->GetDevice()).Warnings().empty());
  scene.fluence.clear();
  EXPECT_EQ(1u, scene.Caster(this->GetDevice()).Warnings().size());
}

TEST_F(Table, IsTheChosenFace)
{
  for (int face = 0; face < 6; ++face)
  {
    Vec outwards = {};
    outwards[face / 2] = face % 2 ? 1.0 : -1.0;
    Scene scene = LitTable(5.0, outwards);
    scene.settings.tableFace = face;
    // Brighter along x, y and z, which tells where on the table a pixel lies.
    scene.fluence = AtCentres(scene.grid, [](double x, double y, double z) { return 1.0 + x + 2.0 * y + 4.0 * z; });
    const Camera camera = Along(scene.grid, outwards, 4.0);
    const Picture picture = scene.Seen(this->GetDevice(), camera);
    ForEveryPixel(picture, camera, [&](std::size_t pixel, const Ray& ray) {
      Vec at = ray.from;
      at[face / 2] = face % 2 ? scene.grid.size[face / 2] - 0.5 : 0.5;
      const double fluence = 1.0 + at[0] / 24.0 + 2.0 * at[1] / 20.0 + 4.0 * at[2] / 16.0;
      EXPECT_NEAR(0.4 * fluence / Pi, picture.radiance[3 * pixel + 1], 1e-4) << face;
      EXPECT_EQ(1.0f, picture.alpha[pixel]);
      EXPECT_NEAR(picture.farDepth, picture.depth[pixel], 1e-3);
    });
  }
}

TEST_F(Table, IsSeenThroughTheMedium)
{
  Scene scene = LitTable(5.0, { 0.0, 0.0, -1.0 });
  scene.sigma_a = scene.Everywhere(0.04);
  scene.illumination.environment = DirectionEnvironment();
  const Picture scattered = scene.Seen(this->GetDevice(), FromAbove(scene.grid, 3.0));
  ExpectColour(scene, scattered, 5.0 / Pi * std::exp(-0.04 * 16.0));
  scene.settings.tableColor = { 0.0, 0.0, 0.0 };
  scene.settings.tableReflectance = 0.7;
  const Vec down = Unit({ 0.2, 0.0, -1.0 });
  const Picture mirrored = scene.Seen(this->GetDevice(), Along(scene.grid, down, 0.5));
  const double twice = 0.7 * std::exp(-2.0 * 0.04 * 16.0 / -down[2]);
  const Vec seen = SeenDirection(mirrored, Middle(mirrored), twice);
  EXPECT_NEAR(down[0], seen[0], 1e-4);
  EXPECT_NEAR(down[1], seen[1], 1e-4);
  EXPECT_NEAR(-down[2], seen[2], 1e-4);
}

// With a lens above it rays bend, and come back from the table through the lens.
TEST_F(Table, MirrorsThroughALens)
{
  Scene scene = LitTable(0.0, { 0.0, 0.0, -1.0 });
  scene.settings.tableColor = { 0.0, 0.0, 0.0 };
  scene.settings.tableReflectance = 1.0;
  scene.illumination.environment = DirectionEnvironment();
  scene.ior = Layers(scene.grid, 1.0, 1.4, 12.0, 5.0);
  const Vec down = Unit({ 0.3, 0.1, -1.0 });
  const Picture picture = scene.Seen(this->GetDevice(), Along(scene.grid, down, 0.5));
  const Vec seen = SeenDirection(picture, Middle(picture));
  EXPECT_NEAR(down[0], seen[0], 1e-3);
  EXPECT_NEAR(down[1], seen[1], 1e-3);
  EXPECT_NEAR(-down[2], seen[2], 1e-3);
}

// Irradiance is what it is in the medium on the table: its light grows no further there, and falls by n^2 on its way
// out.
TEST_F(Table, UnderGlassLosesTheSquareOfTheIndex)
{
  Scene scene = LitTable(5.0, { 0.0, 0.0, -1.0 });
  scene.ior = Layers(scene.grid, 1.0, 1.4, 12.0, 5.0);
  ExpectColour(scene, scene.Seen(this->GetDevice(), FromAbove(scene.grid, 3.0)), 5.0 / Pi / (1.4 * 1.4));
}

TEST_F(Table, IsNotThereFromBelow)
{
  Scene scene = Blobs();
  scene.illumination.environment = SmoothEnvironment();
  scene.ior = Ball(scene.grid, 0.2, 1.3);
  const Camera below = Along(scene.grid, { 0.1, 0.2, 1.0 }, 10.0);
  const Picture without = scene.Seen(this->GetDevice(), below);
  scene.settings.tableFace = 4;
  const Picture with = scene.Seen(this->GetDevice(), below);
  EXPECT_EQ(without.radiance, with.radiance);
  EXPECT_EQ(without.alpha, with.alpha);
}

// With a table straight rays take the way of bent ones: what they meet before it is the same.
TEST_F(Table, ChangesNothingBesideIt)
{
  Scene scene = Blobs();
  const Camera above = Along(scene.grid, { 1.0, 0.3, -0.05 }, 8.0);
  const Picture without = scene.Seen(this->GetDevice(), above);
  scene.settings.tableFace = 4;
  const Picture with = scene.Seen(this->GetDevice(), above);
  EXPECT_LT(LargestDifference(without.radiance, with.radiance), 1e-4);
  EXPECT_LT(LargestDifference(without.alpha, with.alpha), 1e-4);
}
}
