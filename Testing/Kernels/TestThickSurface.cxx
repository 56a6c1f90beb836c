#include "ViewScene.h"

#include "Reference/SlabReference.h"

#include "LightPropagation/Conservative/ConservativePropagation.h"
#include "LightPropagation/Conservative/SurfaceRadiance.h"
#include "Medium/BoxFaces.h"

#include <limits>

using namespace tyndall;
using namespace viewing;

namespace
{
/// Media whose voxels at the visible faces of the box are many mean free paths thick: light changes within them.
class ThickSurface : public DeviceTest
{
};

Light Sun(const Vec& direction)
{
  Light sun;
  sun.direction = direction;
  sun.power = { Pi, Pi, Pi };
  return sun;
}

/// Solves, and has the scene see what was found.
void Solve(Device& device, Scene& scene, const PropagationSettings& settings = {})
{
  Medium medium;
  medium.grid = scene.grid;
  medium.sigma_a = Scene::See(scene.sigma_a, scene.components);
  medium.sigma_s = Scene::See(scene.sigma_s, scene.components);
  const LightField light = SolveConservative(device, medium, scene.illumination, settings, {});
  scene.fluence = light.fluence;
  scene.surface = light.surfaceRadiance;
  scene.settings.showBackground = false;
}

/// A slab of 75 mean free paths, `tau` a voxel, at least eight of these.
Scene Slab(double tau, double albedo, const Illumination& illumination)
{
  const int voxels = std::max(8, static_cast<int>(std::lround(75.2 / tau)));
  Scene scene(GridOf(1, 1, voxels, { 50.0, 50.0, 1.0 }));
  scene.sigma_s = scene.Everywhere(tau * albedo);
  scene.sigma_a = scene.Everywhere(tau * (1.0 - albedo));
  scene.illumination = illumination;
  scene.settings.imageSize = { 3, 3 };
  return scene;
}

const PropagationSettings Endless = [] {
  PropagationSettings settings;
  settings.periodic = { true, true, false };
  return settings;
}();

/// What leaves a slab upwards at a cosine to its normal.
double LeavesAt(Device& device, const Scene& slab, double mu)
{
  Camera camera = Along(slab.grid, { std::sqrt(1.0 - mu * mu), 0.0, -mu }, 1e-4);
  const double up = 0.5 * slab.grid.Length(2); // to the middle of its upper face
  camera.focalPoint[2] += up;
  camera.position[2] += up;
  const Picture picture = slab.Seen(device, camera);
  return picture.radiance[3 * Middle(picture)];
}

/// Chandrasekhar's H for albedo 0.99 and 1.
struct TabulatedH
{
  double mu, of99, of1;
};

std::vector<TabulatedH> ReadH()
{
  std::vector<TabulatedH> rows;
  for (double mu : { 0.1, 0.2, 0.5, 0.8, 1.0 })
  {
    rows.push_back({ mu, ChandrasekharH(0.99, mu), ChandrasekharH(1.0, mu) });
  }
  return rows;
}

TEST(HalfSpace, HIsThatOfTheTable)
{
  for (const TabulatedH& h : ReadH())
  {
    EXPECT_NEAR(h.of99, HalfSpaceH(0.99, h.mu), 0.01 * h.of99);
    EXPECT_NEAR(h.of1, HalfSpaceH(1.0, h.mu), 0.01 * h.of1);
  }
  EXPECT_EQ(1.0, HalfSpaceH(0.0, 0.7));
  EXPECT_EQ(1.0, HalfSpaceH(1.0, 0.0));
}

// Diffuse light L on a half-space comes back as L (1 - sqrt(1 - albedo) H(mu)).
TEST_F(ThickSurface, SlabUnderASkyLooksLikeAHalfSpace)
{
  for (double tau : { 1.5, 3.0, 9.4, 100.0 })
  {
    for (bool sky : { true, false })
    {
      Illumination light;
      (sky ? light.sky : light.faces[5]) = { 1.0, 1.0, 1.0 };
      Scene slab = Slab(tau, 0.99, light);
      Solve(this->GetDevice(), slab, Endless);
      for (const TabulatedH& h : ReadH())
      {
        const double exact = 1.0 - 0.1 * h.of99;
        EXPECT_NEAR(exact, LeavesAt(this->GetDevice(), slab, h.mu), 0.02 * exact) << tau << " " << sky << " " << h.mu;
      }
    }
  }
}

// A colour whose surface radiance is not known looks as without any, the others as with it.
TEST_F(ThickSurface, SurfaceRadianceMayBeUnknownInOneColour)
{
  Illumination light;
  light.sky = { 1.0, 1.0, 1.0 };
  Scene slab = Slab(9.4, 0.99, light);
  Solve(this->GetDevice(), slab, Endless);
  const std::vector<float> fluence = slab.fluence, surface = slab.surface;
  slab.fluence.clear();
  for (const float value : fluence)
  {
    slab.fluence.insert(slab.fluence.end(), 3, value);
  }
  const Camera camera = Along(slab.grid, { 0.6, 0.0, -0.8 }, 1e-4);
  const Picture all = slab.Seen(this->GetDevice(), camera);
  slab.surface.clear();
  const Picture none = slab.Seen(this->GetDevice(), camera);
  for (const float value : surface)
  {
    slab.surface.insert(slab.surface.end(), { value, std::numeric_limits<float>::quiet_NaN(), value });
  }
  const Picture red = slab.Seen(this->GetDevice(), camera);
  const std::size_t at = 3 * Middle(red);
  EXPECT_GT(std::abs(all.radiance[at] - none.radiance[at]), 0.02f * all.radiance[at]);
  EXPECT_EQ(red.radiance[at], all.radiance[at]);
  EXPECT_EQ(red.radiance[at + 1], none.radiance[at + 1]);
  EXPECT_EQ(red.radiance[at + 2], all.radiance[at + 2]);
}

// A beam of irradiance pi across it: albedo H(mu) H(mu0) mu0 / (4 (mu + mu0)).
TEST_F(ThickSurface, SlabInTheSunLooksLikeAHalfSpace)
{
  Illumination light;
  light.lights = { Sun({ 0.0, 0.0, -1.0 }) };
  Scene slab = Slab(9.4, 0.99, light);
  Solve(this->GetDevice(), slab, Endless);
  for (const TabulatedH& h : ReadH())
  {
    const double exact = 0.99 * h.of99 * ChandrasekharH(0.99, 1.0) / (4.0 * (h.mu + 1.0));
    EXPECT_NEAR(exact, LeavesAt(this->GetDevice(), slab, h.mu), 0.02 * exact) << h.mu;
  }
}

// Light from the other side leaves like H, and as much of it as a thick slab transmits.
TEST_F(ThickSurface, LightThroughASlabLeavesAsFromDeepWithin)
{
  Illumination light;
  light.faces[4] = { 1.0, 1.0, 1.0 };
  for (double tau : { 3.0, 9.4, 20.0 })
  {
    Scene slab = Slab(tau, 1.0, light);
    Solve(this->GetDevice(), slab, Endless);
    for (const TabulatedH& h : ReadH())
    {
      const double exact = ThickSlabTransmittance(slab.grid.size[2] * tau) * h.of1 / 2.309401;
      EXPECT_NEAR(exact, LeavesAt(this->GetDevice(), slab, h.mu), 0.02 * exact) << tau << " " << h.mu;
    }
  }
}

TEST_F(ThickSurface, EveryColourIsSeenAsIfItWereAlone)
{
  Illumination light;
  light.sky = { 1.0, 1.0, 1.0 };
  light.lights = { Sun({ 0.3, 0.2, -1.0 }) };
  Scene coloured = Slab(9.4, 1.0, light);
  const std::array<double, 3> albedos = { 1.0, 0.99, 0.95 };
  coloured.components = 3;
  coloured.sigma_s.clear();
  coloured.sigma_a.clear();
  for (std::size_t voxel = 0; voxel < coloured.grid.VoxelCount(); ++voxel)
  {
    for (double albedo : albedos)
    {
      coloured.sigma_s.push_back(static_cast<float>(9.4 * albedo));
      coloured.sigma_a.push_back(static_cast<float>(9.4 * (1.0 - albedo)));
    }
  }
  Solve(this->GetDevice(), coloured, Endless);
  ASSERT_EQ(12 * BoxFaceCellCount(coloured.grid), coloured.surface.size());
  for (int c = 0; c < 3; ++c)
  {
    Scene alone = Slab(9.4, albedos[c], light);
    Solve(this->GetDevice(), alone, Endless);
    Camera camera = Along(alone.grid, { 0.8, 0.0, -0.6 }, 1e-4);
    camera.focalPoint[2] += 4.0; // to the middle of its upper face
    camera.position[2] += 4.0;
    const Picture grey = alone.Seen(this->GetDevice(), camera);
    const Picture colours = coloured.Seen(this->GetDevice(), camera);
    EXPECT_NEAR(grey.radiance[3 * Middle(grey)], colours.radiance[3 * Middle(colours) + c],
      1e-3 * grey.radiance[3 * Middle(grey)]);
  }
}

// A sky of radiance 1 about whatever does not absorb: 1 everywhere.
TEST_F(ThickSurface, FurnaceStaysUniform)
{
  for (double thickest : { 2.0, 30.0 })
  {
    Scene scene(GridOf(7, 6, 5, { 1.0, 1.3, 0.8 }));
    scene.sigma_s = Random(scene.grid.VoxelCount(), static_cast<float>(thickest), 3);
    scene.sigma_a = scene.Everywhere(0.0);
    scene.illumination.sky = { 1.0, 1.0, 1.0 };
    PropagationSettings settings;
    settings.tolerance = 1e-6;
    Solve(this->GetDevice(), scene, settings);
    ASSERT_FALSE(scene.surface.empty());
    scene.settings.showBackground = true;
    for (const Vec& direction : { Vec{ 0.6, 0.7, -0.5 }, Vec{ -1.0, 0.2, -0.1 }, Vec{ 0.0, 0.0, 1.0 } })
    {
      const Picture picture = scene.Seen(this->GetDevice(), Along(scene.grid, direction, 6.0));
      for (float value : picture.radiance)
      {
        ASSERT_NEAR(1.0, value, 1e-3) << thickest;
      }
    }
  }
}

/// Light that leaves a homogeneous box against `direction` at `at`, by random walks from the eye: an independent check.
class Walks
{
public:
  Walks(Vec size, double sigma, double albedo, Illumination light)
    : Size(size)
    , Sigma(sigma)
    , Albedo(albedo)
    , Shining(std::move(light))
  {
  }

  double Radiance(const Vec& at, const Vec& direction, int walks, double* error)
  {
    double sum = 0.0, squares = 0.0;
    for (int n = 0; n < walks; ++n)
    {
      const double found = this->Walk(at, direction);
      sum += found;
      squares += found * found;
    }
    const double mean = sum / walks;
    *error = std::sqrt(std::max(squares / walks - mean * mean, 0.0) / walks);
    return mean;
  }

private:
  double Uniform() { return std::uniform_real_distribution<double>(0.0, 1.0)(this->Random); }

  /// To the box's border; which face.
  double Distance(const Vec& p, const Vec& d, int* face) const
  {
    double nearest = 1e300;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double to = d[axis] > 0.0 ? (this->Size[axis] - p[axis]) / d[axis]
        : d[axis] < 0.0               ? -p[axis] / d[axis]
                                      : 1e300;
      if (to < nearest)
      {
        nearest = to;
        *face = 2 * axis + (d[axis] > 0.0);
      }
    }
    return std::max(nearest, 0.0);
  }

  double Walk(Vec p, Vec d)
  {
    double weight = 1.0, gathered = 0.0;
    for (int n = 0; n < 100000; ++n)
    {
      int face = 0;
      const double out = this->Distance(p, d, &face);
      const double free = -std::log(1.0 - this->Uniform()) / this->Sigma;
      if (free >= out)
      {
        return gathered + weight * (this->Shining.sky[0] + this->Shining.faces[face][0]);
      }
      for (int axis = 0; axis < 3; ++axis)
      {
        p[axis] += free * d[axis];
      }
      weight *= this->Albedo;
      for (const Light& sun : this->Shining.lights)
      {
        const Vec back = Unit({ -sun.direction[0], -sun.direction[1], -sun.direction[2] });
        gathered += weight * sun.power[0] * std::exp(-this->Sigma * this->Distance(p, back, &face)) / (4.0 * Pi);
      }
      if (weight < 0.01)
      {
        if (this->Uniform() > 0.5)
        {
          return gathered;
        }
        weight *= 2.0;
      }
      const double z = 2.0 * this->Uniform() - 1.0;
      const double angle = 2.0 * Pi * this->Uniform();
      const double r = std::sqrt(1.0 - z * z);
      d = { r * std::cos(angle), r * std::sin(angle), z };
    }
    return gathered;
  }

  Vec Size;
  double Sigma, Albedo;
  Illumination Shining;
  std::mt19937 Random{ 5 };
};

/// A cube of eight voxels an edge, 9.4 mean free paths each, and how far pictures of it are from random walks, where
/// rays come in at least `margin` voxels from an edge of the cube.
struct Deviation
{
  double rootMeanSquare = 0.0, worst = 0.0; ///< of the largest radiance
};
Deviation FromWalks(Device& device, const Scene& scene, const Vec& direction, double albedo, double margin)
{
  const Camera camera = Along(scene.grid, direction, 6.5);
  const Picture picture = scene.Seen(device, camera);
  Walks walks({ 8.0, 8.0, 8.0 }, 9.4, albedo, scene.illumination);
  Deviation deviation;
  double largest = 0.0, squares = 0.0;
  int count = 0;
  ForEveryPixel(picture, camera, [&](std::size_t pixel, const Ray& ray) {
    double in = 0.0;
    for (int axis = 0; axis < 3; ++axis)
    {
      const double d = ray.direction[axis];
      in = std::max(in, ((d > 0.0 ? 0.0 : 8.0) - ray.from[axis]) / d);
    }
    Vec at;
    int inside = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
      at[axis] = ray.from[axis] + in * ray.direction[axis];
      inside += at[axis] > margin && at[axis] < 8.0 - margin;
      at[axis] = std::clamp(at[axis], 0.0, 8.0);
    }
    if (inside < 2 || Chord(ray, scene.grid) <= 0.0)
    {
      return;
    }
    double error = 0.0;
    const double exact = walks.Radiance(at, ray.direction, 3000, &error);
    const double off = std::abs(picture.radiance[3 * pixel] - exact);
    largest = std::max(largest, exact);
    deviation.worst = std::max(deviation.worst, off - 3.0 * error);
    squares += std::max(off * off - error * error, 0.0);
    ++count;
  });
  deviation.rootMeanSquare = std::sqrt(squares / count) / largest;
  deviation.worst /= largest;
  return deviation;
}

TEST_F(ThickSurface, CubeLooksAsRandomWalksSay)
{
  for (double albedo : { 1.0, 0.99 })
  {
    for (const char* lit : { "sky", "face", "sun" })
    {
      Scene scene(GridOf(8, 8, 8));
      scene.settings.imageSize = { 12, 12 };
      scene.sigma_s = scene.Everywhere(9.4 * albedo);
      scene.sigma_a = scene.Everywhere(9.4 * (1.0 - albedo));
      const std::string by = lit;
      scene.illumination.sky[0] = scene.illumination.sky[1] = scene.illumination.sky[2] = by == "sky" ? 1.0 : 0.0;
      scene.illumination.faces[5][0] = scene.illumination.faces[5][1] = scene.illumination.faces[5][2] =
        by == "face" ? 1.0 : 0.0;
      scene.illumination.lights = by == "sun" ? std::vector<Light>{ Sun({ 0.5, 0.3, -0.9 }) } : std::vector<Light>();
      Solve(this->GetDevice(), scene);
      for (const Vec& direction : { Vec{ 0.6, 0.7, -0.5 }, Vec{ -1.0, 0.2, -0.3 }, Vec{ 0.1, 0.2, -1.0 } })
      {
        const Deviation deviation = FromWalks(this->GetDevice(), scene, direction, albedo, 1.5);
        std::printf("%s, albedo %g, seen along (%g, %g, %g): %.4f, worst %.4f\n", lit, albedo, direction[0],
          direction[1], direction[2], deviation.rootMeanSquare, deviation.worst);
        // The solver's sun brings some voxels twice what it brings to others, which leaves 3% on faces that it grazes.
        EXPECT_LT(deviation.rootMeanSquare, by == "sun" ? 0.035 : 0.01);
      }
    }
  }
}

// Of what the sun's rays bring to a voxel at the surface, the light of a glowing voxel beside it is no part.
TEST_F(ThickSurface, SunAndAGlowingVoxelAddUp)
{
  const Grid grid = GridOf(11, 11, 11, { 1.0, 1.0, 1.0 });
  const std::vector<float> sigma_s(grid.VoxelCount(), 1.8f), sigma_a(grid.VoxelCount(), 0.2f);
  const auto solve = [&](bool sun, float glow) {
    std::vector<float> emission(grid.VoxelCount(), 0.0f);
    emission[9 * 121 + 5 * 11 + 5] = glow; // the voxel below the middle of the upper face
    Medium medium;
    medium.grid = grid;
    medium.sigma_a = Scene::See(sigma_a, 1);
    medium.sigma_s = Scene::See(sigma_s, 1);
    medium.emission = Scene::See(emission, 1);
    Illumination light;
    if (sun)
    {
      light.lights = { Sun({ 0.3, -0.5, -0.8 }) };
    }
    return SolveConservative(this->GetDevice(), medium, light, {}, {}).surfaceRadiance;
  };
  const std::vector<float> both = solve(true, 10.0f), ofSun = solve(true, 0.0f), ofVoxel = solve(false, 10.0f);
  ASSERT_FALSE(both.empty());
  ASSERT_EQ(both.size(), ofSun.size());
  ASSERT_EQ(both.size(), ofVoxel.size());
  double most = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < both.size(); ++i)
  {
    most = std::max(most, std::abs(both[i] - static_cast<double>(ofSun[i]) - ofVoxel[i]));
    largest = std::max<double>(largest, ofSun[i]);
  }
  // What diffusion does not know, 0.1 sqrt(1 - albedo) of the light that comes in, is no light from deep within: so
  // much need not add up. (Taken for the sun's, the voxel's light was off by more than four times the largest.)
  EXPECT_LT(most, 0.07 * largest);
}

TEST_F(ThickSurface, ThinAndClearBordersChangeNothing)
{
  // Thin voxels: not told, and where it is told all the same not used.
  Illumination light;
  light.sky = { 1.0, 1.0, 1.0 };
  Scene thin = Slab(0.45, 0.999, light);
  thin.sigma_s[4] = 40.0f; // within
  Solve(this->GetDevice(), thin, Endless);
  EXPECT_TRUE(thin.surface.empty());
  const double seen = LeavesAt(this->GetDevice(), thin, 0.6);
  thin.surface.assign(4 * BoxFaceCellCount(thin.grid), 7.0f);
  EXPECT_EQ(seen, LeavesAt(this->GetDevice(), thin, 0.6));

  // Shadow rays and single scattering show what they always did.
  Scene thick = Slab(9.4, 0.99, light);
  Solve(this->GetDevice(), thick, Endless);
  ASSERT_FALSE(thick.surface.empty());
  thick.fluenceDirect = thick.Everywhere(0.1);
  thick.settings.singleScatteringOnly = true;
  const double single = LeavesAt(this->GetDevice(), thick, 0.6);
  thick.surface.clear();
  EXPECT_EQ(single, LeavesAt(this->GetDevice(), thick, 0.6));
}

TEST_F(ThickSurface, PacketsOfEveryWidthGiveTheSamePicture)
{
  Scene scene(GridOf(5, 6, 7));
  scene.settings.imageSize = { 40, 30 };
  scene.sigma_s = Random(scene.grid.VoxelCount(), 12.0f, 4);
  scene.sigma_a = Random(scene.grid.VoxelCount(), 0.3f, 5);
  scene.illumination.faces[2] = { 1.0, 1.0, 1.0 };
  Solve(this->GetDevice(), scene);
  ASSERT_FALSE(scene.surface.empty());
  const Camera camera = Along(scene.grid, { 0.5, 0.8, -0.3 }, 5.0);
  const Picture best = scene.Seen(this->GetDevice(), camera);
  for (int width : { 1, 4, 8, 16 })
  {
    scene.settings.packetWidth = width;
    EXPECT_LT(LargestDifference(best.radiance, scene.Seen(this->GetDevice(), camera).radiance), 1e-5) << width;
  }
}
}
