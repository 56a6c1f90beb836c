#include "ReflectingScene.h"
#include "ViewScene.h"

#include <gmock/gmock.h>

using namespace tyndall;

namespace
{
/// A picture, along parallel rays, of a scene that light propagation maps solved.
Picture Look(Device& device, ::Scene& scene, const LightField& light, std::array<double, 3> along,
  const ViewSettings& settings, const std::vector<float>& ior = {})
{
  SolvedLight solved;
  solved.fluence = { light.fluence.data(), light.channels };
  solved.facePower = { light.facePower.empty() ? nullptr : light.facePower.data(), light.channels };
  solved.faceAlbedo = light.faceAlbedo;
  Illumination illumination;
  illumination.sky = scene.light.sky;
  MediumRayCaster caster(
    device, scene.medium, solved, illumination, settings, { ior.empty() ? nullptr : ior.data(), 1 });
  return caster.Render(viewing::Along(scene.medium.grid, along, 1.5));
}

ViewSettings Small()
{
  ViewSettings settings;
  settings.imageSize = { 21, 17 };
  settings.minimumTransmittance = 0.0;
  return settings;
}
}

class GroundView : public DeviceTest
{
};

TEST_F(GroundView, ShowsMattGroundUnderASun)
{
  // Transparent: E albedo / pi, whatever the way it is looked at; absorbing: dimmed on the way down and up.
  for (double absorption : { 0.0, 0.05 })
  {
    ::Scene scene({ 12, 10, 8 }, static_cast<float>(absorption));
    scene.ShineAlong({ 0.0, 0.0, -1.0 }, 2.0);
    scene.light.faceAlbedo[4] = { 0.8, 0.5, 0.3 };
    const LightField light = scene.Solve(this->GetDevice());
    for (const std::array<double, 3>& along : { std::array<double, 3>{ 0.0, 0.0, -1.0 }, { 0.3, -0.2, -1.0 } })
    {
      const Picture picture = Look(this->GetDevice(), scene, light, along, Small());
      const double slant = std::sqrt(along[0] * along[0] + along[1] * along[1] + 1.0);
      const double through = std::exp(-8.0 * absorption * (1.0 + slant));
      const double expected[] = { 0.8, 0.5, 0.3 };
      for (std::size_t i = 0; i < picture.radiance.size(); ++i)
      {
        const double radiance = 2.0 * expected[i % 3] / Pi * through;
        ASSERT_NEAR(picture.radiance[i], radiance, 1e-4 * radiance) << absorption << ' ' << i;
      }
      EXPECT_NEAR(picture.alpha[50], 1.0 - std::exp(-8.0 * absorption * slant), 1e-5);
    }
  }
}

TEST_F(GroundView, IsWhereTheFaceIs)
{
  // Each face has a radiance of its own; one that gives back nothing shows the sky.
  ::Scene scene({ 6, 7, 8 });
  scene.light.sky = Grey(0.25);
  scene.Attach();
  LightField light;
  light.fluence.assign(scene.sigma_a.size(), 0.0f);
  light.facePower.resize(BoxFaceCellCount(scene.medium.grid));
  ForBoxFaceCells(scene.medium.grid,
    [&](const BoxFaceCell& cell) { light.facePower[cell.number] = static_cast<float>(Pi * (1.0 + cell.face)); });
  light.faceAlbedo.fill(Grey(0.5));
  light.faceAlbedo[3] = Grey(0.0);
  for (int face = 0; face < 6; ++face)
  {
    std::array<double, 3> along = { 0.1, 0.05, -0.1 };
    along[face / 2] = face % 2 ? 1.0 : -1.0;
    const double expected = face == 3 ? 0.25 : 0.5 * (1.0 + face);
    for (bool bends : { false, true })
    {
      std::vector<float> ior;
      if (bends)
      {
        ior.assign(scene.sigma_a.size(), 1.0f);
        ior[150] = 1.0f + 1e-6f; // the kernel of bent rays
      }
      const Picture picture = Look(this->GetDevice(), scene, light, along, Small(), ior);
      EXPECT_NEAR(picture.radiance[3 * viewing::Middle(picture)], expected, 1e-4) << face << ' ' << bends;
    }
    ViewSettings hidden = Small();
    hidden.showBackground = false;
    const Picture none = Look(this->GetDevice(), scene, light, along, hidden);
    EXPECT_EQ(none.radiance[3 * viewing::Middle(none)], 0.0f);
  }
}

TEST_F(GroundView, IsSmoothBetweenTheCellsMiddles)
{
  ::Scene scene({ 6, 5, 4 });
  scene.Attach();
  LightField light;
  light.fluence.assign(scene.sigma_a.size(), 0.0f);
  ForBoxFaceCells(scene.medium.grid, [&](const BoxFaceCell& cell) {
    light.facePower.push_back(static_cast<float>(cell.face == 4 ? Pi * (1.0 + cell.u + 10.0 * cell.v) : 0.0));
  });
  light.faceAlbedo[4] = Grey(1.0);
  ViewSettings settings = Small();
  const Picture picture = Look(this->GetDevice(), scene, light, { 0.0, 0.0, -1.0 }, settings);
  const Camera camera = viewing::Along(scene.medium.grid, { 0.0, 0.0, -1.0 }, 1.5);
  viewing::ForEveryPixel(picture, camera, [&](std::size_t pixel, const viewing::Ray& ray) {
    const double expected = 1.0 + (ray.from[0] - 0.5) + 10.0 * (ray.from[1] - 0.5);
    ASSERT_NEAR(picture.radiance[3 * pixel], expected, 1e-4 * expected);
  });
}
