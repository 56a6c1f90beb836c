#include "ViewScene.h"

using namespace tyndall;
using namespace viewing;

namespace
{
class RayEnds : public DeviceTest
{
protected:
  Picture SeenUpTo(const Scene& scene, const Camera& camera, const std::vector<float>& ends)
  {
    return scene.Caster(this->GetDevice()).Render(camera, {}, ends);
  }
};

constexpr float Endless = 1e30f;

std::vector<float> EachPixel(const Scene& scene, float value)
{
  return std::vector<float>(static_cast<std::size_t>(scene.settings.imageSize[0]) * scene.settings.imageSize[1], value);
}

// The one kernel and the other, as LeaveOut chooses.
TEST_F(RayEnds, AbsorberFollowsBeerAndLambertToWhereARayEnds)
{
  Scene scene(GridOf(17, 12, 11, { 1, 2, 0.5 }, { 5, 0, 0 }));
  scene.sigma_a = scene.Everywhere(0.1);
  scene.illumination.sky = { 1.0, 2.0, 3.0 };
  for (bool leaveOut : { true, false })
  {
    scene.settings.leaveOut = leaveOut;
    for (bool parallel : { false, true })
    {
      Camera camera = scene.Framed();
      camera.parallelProjection = parallel;
      const auto forward = Axes(camera)[2];
      const double middle = std::hypot(camera.focalPoint[0] - camera.position[0],
        camera.focalPoint[1] - camera.position[1], camera.focalPoint[2] - camera.position[2]);
      std::vector<float> ends = EachPixel(scene, Endless);
      for (std::size_t pixel = 0; pixel < ends.size(); ++pixel)
      {
        ends[pixel] = pixel % 3 == 0 ? Endless : static_cast<float>(middle - 12.0 + pixel % 25);
      }
      const Picture picture = this->SeenUpTo(scene, camera, ends);
      ForEveryPixel(picture, camera, [&](std::size_t pixel, const Ray& ray) {
        const double cosine =
          ray.direction[0] * forward[0] + ray.direction[1] * forward[1] + ray.direction[2] * forward[2];
        Ray back = ray; // from where it ends, the other way
        for (int axis = 0; axis < 3; ++axis)
        {
          back.from[axis] += ray.direction[axis] * std::min<double>(ends[pixel] / cosine, 1e6);
          back.direction[axis] = -ray.direction[axis];
        }
        const double left = std::exp(-0.1 * Chord(back, scene.grid));
        EXPECT_NEAR(1.0 - left, picture.alpha[pixel], 2e-5);
        EXPECT_NEAR(ends[pixel] < Endless ? 0.0 : 3.0 * left, picture.radiance[3 * pixel + 2], 1e-4);
      });
    }
  }
}

TEST_F(RayEnds, EndlessRaysAreThoseOfThePictureWithoutEnds)
{
  const Scene scene = Blobs();
  const Picture without = scene.Seen(this->GetDevice());
  const Picture with = this->SeenUpTo(scene, scene.Framed(), EachPixel(scene, Endless));
  EXPECT_EQ(without.radiance, with.radiance);
  EXPECT_EQ(without.alpha, with.alpha);
  EXPECT_EQ(without.depth, with.depth);
}

// Behind the end there might as well be nothing.
TEST_F(RayEnds, BentRaysSeeTheMediumBeforeTheirEnd)
{
  Scene scene(GridOf(30, 30, 40));
  scene.settings.stepSize = 0.1;
  scene.settings.showBackground = false;
  scene.ior = AtCentres(scene.grid, [](double x, double y, double z) {
    return 1.0 + 0.5 * std::exp(-60.0 * ((x - 0.4) * (x - 0.4) + (y - 0.5) * (y - 0.5) + (z - 0.6) * (z - 0.6)));
  });
  scene.fluence = AtCentres(scene.grid, [](double x, double y, double) { return 10.0 * (1.0 + x + y); });
  scene.sigma_s = scene.Everywhere(0.05);
  const Camera camera = FromAbove(scene.grid, 5.0);
  const Picture ended = this->SeenUpTo(scene, camera, EachPixel(scene, 5.0f + 25.0f));
  scene.sigma_s = AtCentres(scene.grid, [](double, double, double z) { return z * 40.0 > 15.0 ? 0.05 : 0.0; });
  const Picture emptied = scene.Seen(this->GetDevice(), camera);
  EXPECT_GT(0.001, MeanDistance(ended.alpha, emptied.alpha));
  EXPECT_GT(0.001, MeanDistance(ended.radiance, emptied.radiance));
  EXPECT_LT(0.4, ended.alpha[Middle(ended)]);
}

TEST_F(RayEnds, OfAnotherNumberThanPixelsAreAnError)
{
  const Scene scene = Blobs();
  EXPECT_THROW(this->SeenUpTo(scene, scene.Framed(), { 1.0f, 2.0f }), InvalidInput);
}

// A quarter of a picture, as a larger picture is made of tiles.
TEST_F(RayEnds, ShiftedCameraSeesAPartOfTheWhole)
{
  Scene scene = Blobs();
  for (bool parallel : { false, true })
  {
    Camera camera = scene.Framed();
    camera.parallelProjection = parallel;
    scene.settings.imageSize = { 60, 40 };
    const Picture whole = scene.Seen(this->GetDevice(), camera);
    scene.settings.imageSize = { 30, 20 };
    Camera part = camera;
    part.viewAngle = std::atan(0.5 * std::tan(camera.viewAngle * Pi / 360.0)) * 360.0 / Pi;
    part.parallelScale *= 0.5;
    part.shift = { 1.0, -1.0 };
    const Picture quarter = scene.Seen(this->GetDevice(), part);
    for (int j = 0; j < 20; ++j)
    {
      for (int i = 0; i < 30; ++i)
      {
        EXPECT_NEAR(whole.radiance[3 * (j * 60 + i + 30)], quarter.radiance[3 * (j * 30 + i)], 2e-4);
      }
    }
  }
}
}
