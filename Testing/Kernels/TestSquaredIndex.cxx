// The spline of n^2 that photons and rays follow: exact for smooth fields, and positive whatever the voxels hold.
#include "DeviceTest.h"
#include "PhotonScene.h"

#include "Refraction/Index/IndexField.h"

#include <random>

using namespace tyndall;

namespace
{
/// Coefficients with their padding of two, and the voxels' n^2 from which they come.
struct Spline
{
  std::array<int, 3> size;
  std::vector<float> coefficients, squared;

  Spline(Device& device, const PhotonScene& scene)
    : size(scene.medium.grid.size)
  {
    const Buffer<float> index(device, scene.ior.data(), scene.ior.size(), "ior");
    this->coefficients = SquaredIndexCoefficients(device, scene.medium.grid, index).Read();
    for (const float n : scene.ior)
    {
      this->squared.push_back(n * n);
    }
  }

  float At(int i, int j, int k) const
  {
    return this->coefficients[((k + 2) * (this->size[1] + 4) + j + 2) * (this->size[0] + 4) + i + 2];
  }

  /// The spline at the centre of an inner voxel.
  double Centre(int i, int j, int k) const
  {
    const double w[3] = { 1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0 };
    double sum = 0.0;
    for (int n = 0; n < 27; ++n)
    {
      const int x = n % 3, y = n / 3 % 3, z = n / 9;
      sum += w[x] * w[y] * w[z] * this->At(i + x - 1, j + y - 1, k + z - 1);
    }
    return sum;
  }
};
}

class SquaredIndexTest : public DeviceTest
{
};

TEST_F(SquaredIndexTest, MeetsQuadraticFieldsExactlyAtTheirExtremesToo)
{
  // A hill and a bowl, the latter 0.3 deep over 4 voxels: second differences of 0.04 where n^2 is 0.7.
  for (double curvature : { -0.02, 0.02 })
  {
    PhotonScene scene(12, 6.0);
    scene.SetIndex([&](double x, double y, double z) {
      return std::sqrt((curvature < 0.0 ? 3.4 : 0.7) + curvature * (x * x + y * y + z * z));
    });
    const Spline spline(this->GetDevice(), scene);
    for (int k = 2; k < 10; ++k)
    {
      for (int j = 2; j < 10; ++j)
      {
        for (int i = 2; i < 10; ++i)
        {
          EXPECT_NEAR(spline.Centre(i, j, k), spline.squared[(k * 12 + j) * 12 + i], 2e-6) << i << ' ' << j << ' ' << k;
        }
      }
    }
  }
}

TEST_F(SquaredIndexTest, StaysWithinAnEighthOfItsVoxelsWhereTheyJump)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  for (double highest : { 1.5, 4.0, 100.0 })
  {
    PhotonScene scene({ 9, 7, 8 }, 1.0, 4.0, 0.0f, 0.0f);
    scene.SetIndex([&](double, double, double) { return uniform(random) < 0.5 ? 1.0 : highest; });
    const Spline spline(this->GetDevice(), scene);
    for (int k = 1; k < 7; ++k)
    {
      for (int j = 1; j < 6; ++j)
      {
        for (int i = 1; i < 8; ++i)
        {
          float low = 1e30f, high = 0.0f;
          for (const auto& d : { std::array<int, 3>{ 0, 0, 0 }, { 1, 0, 0 }, { -1, 0, 0 }, { 0, 1, 0 }, { 0, -1, 0 },
                 { 0, 0, 1 }, { 0, 0, -1 } })
          {
            const float f = spline.squared[((k + d[2]) * 7 + j + d[1]) * 9 + i + d[0]];
            low = std::min(low, f);
            high = std::max(high, f);
          }
          EXPECT_GE(spline.At(i, j, k), 0.874f * low);
          EXPECT_LE(spline.At(i, j, k), 1.126f * high);
        }
      }
    }
    for (const float c : spline.coefficients)
    {
      EXPECT_GT(c, 0.0f); // beyond the grid, too
    }
  }
}
