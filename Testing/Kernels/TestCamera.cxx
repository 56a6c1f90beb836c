#include "ErrorWords.h"
#include "ViewScene.h"

using namespace tyndall;
using namespace viewing;

namespace
{
TEST(Camera, FramesTheWholeBoxTightly)
{
  for (const Grid& grid : { GridOf(64, 64, 64), GridOf(200, 3, 10), GridOf(1, 1, 500, { 1, 1, 0.1 }, { 70, 0, -9 }) })
  {
    for (double aspect : { 4.0 / 3.0, 0.5 })
    {
      for (const Vec& towards : { Vec{ 0.55, -1.0, 0.5 }, Vec{ 0.0, 0.0, 1.0 }, Vec{ 1.0, 0.0, 0.0 } })
      {
        Camera camera = FrameGrid(grid, aspect, 40.0, towards);
        const auto axes = Axes(camera);
        double edge = 0.0;
        double parallelEdge = 0.0;
        for (int corner = 0; corner < 8; ++corner)
        {
          Vec seen = {};
          for (int axis = 0; axis < 3; ++axis)
          {
            const double at =
              grid.origin[axis] + (corner >> axis & 1 ? grid.Length(axis) : 0.0) - camera.position[axis];
            for (int c = 0; c < 3; ++c)
            {
              seen[c] += at * axes[c][axis];
            }
          }
          ASSERT_GT(seen[2], 0.0);
          const double farthest = std::max(std::abs(seen[0]) / aspect, std::abs(seen[1]));
          edge = std::max(edge, farthest / (seen[2] * std::tan(20.0 * Pi / 180.0)));
          parallelEdge = std::max(parallelEdge, farthest / camera.parallelScale);
        }
        EXPECT_NEAR(1.0 / 1.05, edge, 1e-9);
        EXPECT_NEAR(1.0 / 1.05, parallelEdge, 1e-9);
      }
    }
  }
}

// Squares of such lengths are no numbers any more, or nothing.
TEST(Camera, KnowsItsAxesAtEveryScale)
{
  Camera near;
  near.position = { 3.0, -2.0, 1.0 };
  near.focalPoint = { -1.0, 1.0, 0.5 };
  near.viewUp = { 0.1, 0.2, 1.0 };
  const auto expected = Axes(near);
  for (double scale : { 1e-300, 1e-160, 1e160, 5e307 })
  {
    Camera camera = near;
    for (Vec* v : { &camera.position, &camera.focalPoint, &camera.viewUp })
    {
      for (double& component : *v)
      {
        component *= scale;
      }
    }
    const auto axes = Axes(camera);
    for (int i = 0; i < 9; ++i)
    {
      EXPECT_NEAR(expected[i / 3][i % 3], axes[i / 3][i % 3], 1e-12) << scale;
    }
  }
}

TEST(Camera, SaysThatViewUpIsZeroWhereItIs)
{
  Camera camera;
  camera.position = { 1.0, 2.0, 3.0 };
  const auto said = [&](const Vec& viewUp) {
    camera.viewUp = viewUp;
    return ErrorWords([&] { Axes(camera); });
  };
  EXPECT_NE(std::string::npos, said({ 0.0, 0.0, 0.0 }).find("zero"));
  EXPECT_NE(std::string::npos, said({ 2.0, 4.0, 6.0 }).find("along its view"));
}
}
