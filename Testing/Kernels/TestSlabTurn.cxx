// Slabs with their layers along any axis: all that is found is that of the slab along x, by other names.

#include "DeviceTest.h"
#include "ErrorWords.h"
#include "MediumScene.h"

#include "Medium/BoxFaces.h"
#include "Numerics/Constants.h"
#include "Numerics/Legendre.h"

#include <gmock/gmock.h>

using namespace tyndall;

namespace
{
constexpr int Layers = 13;

/// What lies along x in a scene along x, as it is called in one along another axis.
template <class Value>
std::array<Value, 3> LyingAlong(int axis, const std::array<Value, 3>& alongX)
{
  std::array<Value, 3> lying = {};
  for (int a = 0; a < 3; ++a)
  {
    lying[(a + axis) % 3] = alongX[a];
  }
  return lying;
}

int FaceLyingAlong(int axis, int face)
{
  return (face / 2 + axis) % 3 * 2 + face % 2;
}

/// Coloured layers of their own density each under a slanting sun, lit through both faces, ground behind one.
Scene SlabAlong(int axis)
{
  Scene scene(LyingAlong<int>(axis, { Layers, 1, 1 }));
  scene.medium.grid.spacing = LyingAlong<double>(axis, { 0.3, 0.2, 0.5 });
  scene.Randomise(2.0, 1.0, 0.95, 5);
  std::vector<float> coloured;
  for (std::size_t i = 0; i < scene.sigma_s.size(); ++i)
  {
    for (const float part : { 1.0f, 0.7f, 0.4f })
    {
      coloured.push_back(part * scene.sigma_s[i]);
    }
  }
  scene.sigma_s = coloured;
  scene.medium.phase = PhaseFunction::HenyeyGreenstein(0.7);
  scene.ShineAlong(LyingAlong<double>(axis, { -0.6, 0.3, 0.5 }), 2.0);
  scene.light.faces[FaceLyingAlong(axis, 0)] = { 0.1, 0.2, 0.3 };
  scene.light.faceAlbedo[FaceLyingAlong(axis, 0)] = { 0.5, 0.2, 0.1 };
  scene.light.sky = { 0.05, 0.05, 0.1 };
  scene.settings.periodic = LyingAlong<bool>(axis, { false, true, true });
  scene.settings.angularDegree = 4;
  scene.settings.netFlux = true;
  scene.settings.facePower = true;
  return scene;
}

/// Of the moments of a voxel, in a direction.
double Radiance(const LightField& light, std::size_t voxel, int channel, const std::array<double, 3>& omega)
{
  const std::size_t harmonics = light.scatteredMoments.size() / (Layers * light.channels);
  const std::vector<double> values =
    SphericalHarmonics(static_cast<int>(std::lround(std::sqrt(static_cast<double>(harmonics)))) - 1, omega);
  double sum = 0.0;
  for (std::size_t j = 0; j < harmonics; ++j)
  {
    sum += std::sqrt(4.0 * Pi) * values[j] * light.scatteredMoments[(voxel * harmonics + j) * light.channels + channel];
  }
  return sum;
}
}

class SlabTurns
  : public DeviceTest
  , public testing::WithParamInterface<int>
{
};

TEST_P(SlabTurns, GiveBackWhatASlabAlongXHas)
{
  const int axis = GetParam();
  Scene along = SlabAlong(0), other = SlabAlong(axis);
  const LightField expected = along.Solve(this->GetDevice()), light = other.Solve(this->GetDevice());
  ASSERT_EQ(light.fluence.size(), expected.fluence.size());
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    EXPECT_NEAR(light.fluence[i], expected.fluence[i], 1e-6 * expected.fluence[i]);
    EXPECT_NEAR(light.fluenceDirect[i], expected.fluenceDirect[i], 1e-6 * expected.fluence[i]);
    const std::array<float, 3> flux =
      LyingAlong<float>(axis, { expected.netFlux[3 * i], expected.netFlux[3 * i + 1], expected.netFlux[3 * i + 2] });
    for (int a = 0; a < 3; ++a)
    {
      EXPECT_NEAR(light.netFlux[3 * i + a], flux[a], 1e-6 * expected.fluence[i]);
    }
  }
  const std::array<double, 3> towards = { 0.36, -0.48, 0.8 };
  for (std::size_t voxel = 0; voxel < Layers; ++voxel)
  {
    const double radiance = Radiance(expected, voxel, 1, towards);
    EXPECT_NEAR(Radiance(light, voxel, 1, LyingAlong(axis, towards)), radiance, 1e-5 * std::abs(radiance) + 1e-7);
  }
  for (int face = 0; face < 6; ++face)
  {
    const int lying = FaceLyingAlong(axis, face);
    EXPECT_EQ(light.faceAlbedo[lying], expected.faceAlbedo[face]);
    for (int c = 0; c < 3; ++c)
    {
      EXPECT_NEAR(light.facePowerOut[lying][c], expected.facePowerOut[face][c], 1e-6);
    }
    const std::size_t first = LayoutOfFace(other.medium.grid, lying).first * 3;
    const std::size_t firstAlong = LayoutOfFace(along.medium.grid, face).first * 3;
    for (std::size_t i = 0; i < 3 * (face < 2 ? 1 : Layers); ++i)
    {
      EXPECT_NEAR(light.facePower[first + i], expected.facePower[firstAlong + i], 1e-5);
    }
  }
  ASSERT_EQ(light.lampsApart.size(), expected.lampsApart.size());
  for (std::size_t i = 0; i < light.lampsApart.size(); ++i)
  {
    EXPECT_EQ(light.lampsApart[i].direction, LyingAlong(axis, expected.lampsApart[i].direction));
  }
}

INSTANTIATE_TEST_SUITE_P(Axes, SlabTurns, testing::Values(1, 2));

/// A slab that an environment shines on is solved as it stands; this one is black.
TEST_P(SlabTurns, AreAsGoodAsNone)
{
  Scene scene = SlabAlong(GetParam());
  const LightField light = scene.Solve(this->GetDevice());
  scene.light.environment.width = 2;
  scene.light.environment.height = 1;
  scene.light.environment.radiance.assign(6, 0.0f);
  const LightField standing = scene.Solve(this->GetDevice());
  ASSERT_EQ(light.fluence.size(), standing.fluence.size());
  for (std::size_t i = 0; i < light.fluence.size(); ++i)
  {
    EXPECT_NEAR(light.fluence[i], standing.fluence[i], 2e-4 * standing.fluence[i]);
    for (int a = 0; a < 3; ++a)
    {
      EXPECT_NEAR(light.netFlux[3 * i + a], standing.netFlux[3 * i + a], 2e-4 * standing.fluence[i]);
    }
  }
  const std::array<double, 3> towards = { 0.36, -0.48, 0.8 };
  for (std::size_t voxel = 0; voxel < Layers; ++voxel)
  {
    const double radiance = Radiance(standing, voxel, 2, towards);
    EXPECT_NEAR(Radiance(light, voxel, 2, towards), radiance, 1e-3 * std::abs(radiance));
  }
  for (int face = 0; face < 6; ++face)
  {
    EXPECT_NEAR(light.facePowerOut[face][1], standing.facePowerOut[face][1], 2e-4 * light.balance.entered[1]);
  }
}

/// What is wrong is told by the names of the scene as it stands.
TEST_F(DeviceTest, SlabTurnsNameVoxelsAsTheyAreGiven)
{
  Scene scene = SlabAlong(2);
  scene.sigma_a[4] = -1.0f;
  const std::string words = ErrorWords([&] { scene.Solve(this->GetDevice()); });
  EXPECT_THAT(words, testing::HasSubstr("(0, 0, 4)"));
}
