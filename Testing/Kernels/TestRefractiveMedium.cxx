#include "DeviceTest.h"
#include "ErrorWords.h"
#include "MeshShapes.h"

#include "Refraction/Index/IndexField.h"
#include "Refraction/Index/RefractiveMedium.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace tyndall;
using shapes::CubeGrid;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

namespace
{
Material Glass()
{
  return { 1.5, { 0.1, 0.1, 0.1 }, { 0.3, 0.3, 0.3 }, 0.0 };
}

Solid Ball(double radius = 0.6)
{
  return { "Ball", shapes::Sphere({ 0.01, 0.02, 0.03 }, radius, 5), Glass() };
}

class RefractiveMediumTest : public DeviceTest
{
protected:
  RefractiveMedium Made(std::vector<Solid> solids, const RefractiveMediumSettings& settings)
  {
    return Voxelize(this->GetDevice(), std::move(solids), settings);
  }

  void ExpectRefused(std::vector<Solid> solids, const RefractiveMediumSettings& settings, const char* part)
  {
    const std::string words = ErrorWords([&] { this->Made(std::move(solids), settings); });
    EXPECT_THAT(words, HasSubstr(part));
  }
};

RefractiveMediumSettings FogAround(int size = 24)
{
  RefractiveMediumSettings settings;
  settings.grid = CubeGrid(size);
  settings.outside = { 1.0, { 0.0, 0.0, 0.0 }, { 0.7, 0.7, 0.7 }, 0.0 };
  return settings;
}

TEST_F(RefractiveMediumTest, VoxelsAreMeansOfTheirMaterials)
{
  RefractiveMediumSettings settings = FogAround();
  settings.filterSize = 1;
  const RefractiveMedium medium = this->Made({ Ball() }, settings);
  ASSERT_EQ(medium.components, 1);
  int inside = 0, border = 0, outside = 0;
  for (std::size_t i = 0; i < medium.occupancy.size(); ++i)
  {
    const float part = medium.occupancy[i];
    (part == 1.0f ? inside : part == 0.0f ? outside : border) += 1;
    ASSERT_FLOAT_EQ(medium.sigma_a[i], part * 0.1f);
    ASSERT_FLOAT_EQ(medium.sigma_s[i], part * 0.3f + (1.0f - part) * 0.7f);
    ASSERT_FLOAT_EQ(medium.ior[i], part * 1.5f + (1.0f - part) * 1.0f);
    if (part == 1.0f || part == 0.0f) // to the last bit
    {
      ASSERT_EQ(medium.ior[i], part == 1.0f ? 1.5f : 1.0f);
      ASSERT_EQ(medium.sigma_s[i], part == 1.0f ? 0.3f : 0.7f);
    }
  }
  EXPECT_GT(inside, 1000);
  EXPECT_GT(border, 500);
  EXPECT_GT(outside, 1000);
  EXPECT_THAT(medium.leftOut, IsEmpty());
  EXPECT_THAT(medium.warnings, IsEmpty());
  EXPECT_GT(medium.seconds, 0.0);
}

TEST_F(RefractiveMediumTest, PureVoxelsAreExactWithAnyFactor)
{
  RefractiveMediumSettings settings = FogAround(12);
  settings.filterSize = 1;
  settings.voxelization.samples = 3;
  Solid inner = Ball(0.3);
  inner.material.n = 1.37;
  const RefractiveMedium medium = this->Made({ Ball(), inner }, settings);
  const std::size_t centre = (6 * 12 + 6) * 12 + 6;
  EXPECT_EQ(medium.ior[centre], 1.37f);
  EXPECT_EQ(medium.occupancy[centre], 1.0f);
  EXPECT_EQ(medium.ior[0], 1.0f);
}

TEST_F(RefractiveMediumTest, ThePartOutsideIsNotADifferenceOfRoundedParts)
{
  // 1 - k / 65529 is off by many units in the last place of a small part; (65529 - k) / 65529 is not.
  const double whole = 27.0 * UnitsOfSample(3);
  RefractiveMediumSettings settings = FogAround(24);
  settings.filterSize = 1;
  settings.voxelization.samples = 3;
  Solid clear = Ball();
  clear.material.sigma_s = {};
  const RefractiveMedium medium = this->Made({ clear }, settings);
  int small = 0;
  for (std::size_t i = 0; i < medium.sigma_s.size(); ++i)
  {
    const double outside = std::round(whole * (1.0 - medium.occupancy[i]));
    ASSERT_FLOAT_EQ(medium.sigma_s[i], static_cast<float>(0.7 * outside / whole)) << outside << " parts outside";
    small += outside > 0.0 && outside < 0.15 * whole;
  }
  EXPECT_GT(small, 50);
}

TEST_F(RefractiveMediumTest, ColourMakesThreeComponents)
{
  RefractiveMediumSettings settings = FogAround(12);
  settings.outside.sigma_s = { 0.1, 0.2, 0.3 };
  const RefractiveMedium medium = this->Made({ Ball() }, settings);
  ASSERT_EQ(medium.components, 3);
  EXPECT_EQ(medium.sigma_s[1], 0.2f);
  EXPECT_EQ(medium.sigma_a.size(), 3 * settings.grid.VoxelCount());
  const std::size_t centre = 3 * ((6 * 12 + 6) * 12 + 6);
  EXPECT_EQ(medium.sigma_s[centre + 2], 0.3f);
  EXPECT_EQ(medium.sigma_a[centre + 2], 0.1f);
}

TEST_F(RefractiveMediumTest, ConstantIndexIsLeftOut)
{
  RefractiveMediumSettings settings = FogAround(12);
  settings.outside.n = 1.5;
  const RefractiveMedium medium = this->Made({ Ball() }, settings);
  EXPECT_THAT(medium.ior, IsEmpty());
  EXPECT_THAT(medium.iorGradient, IsEmpty());
  EXPECT_THAT(medium.leftOut, ElementsAre(HasSubstr("smoothing of n, ior_gradient")));
  EXPECT_EQ(medium.occupancy.size(), settings.grid.VoxelCount());
}

TEST_F(RefractiveMediumTest, NothingInTheBoxIsAWarning)
{
  Solid away = Ball();
  for (shapes::Point& point : away.mesh.points)
  {
    point[0] += 5.0;
  }
  const RefractiveMedium medium = this->Made({ away }, FogAround(12));
  EXPECT_THAT(medium.warnings, ElementsAre(HasSubstr("Nothing of the box")));
  EXPECT_THAT(medium.ior, IsEmpty());
}

TEST_F(RefractiveMediumTest, VoxelsHaveTheMeanCosineOfTheirMaterials)
{
  RefractiveMediumSettings settings = FogAround(12);
  settings.filterSize = 1;
  settings.outside.g = 0.9;
  Solid ball = Ball();
  ball.material.g = 0.2;
  const RefractiveMedium medium = this->Made({ ball }, settings);
  ASSERT_EQ(medium.gByVoxel.size(), settings.grid.VoxelCount() * medium.components);
  const std::size_t centre = (6 * 12 + 6) * 12 + 6;
  EXPECT_EQ(medium.gByVoxel[0], 0.9f);
  EXPECT_EQ(medium.gByVoxel[centre * medium.components], 0.2f);
  EXPECT_FLOAT_EQ(medium.sigma_s[0], 0.7f) << "scattering is the material's own";
  int mixed = 0;
  for (std::size_t i = 0; i < medium.gByVoxel.size(); ++i)
  {
    const double inside = medium.occupancy[i / medium.components];
    const double within = 0.3 * inside, beyond = 0.7 * (1.0 - inside);
    EXPECT_NEAR(medium.gByVoxel[i], (0.2 * within + 0.9 * beyond) / (within + beyond), 1e-6) << inside;
    mixed += inside > 0.0 && inside < 1.0;
  }
  EXPECT_GT(mixed, 10);
  EXPECT_THAT(medium.leftOut, IsEmpty());
}

TEST_F(RefractiveMediumTest, OneMeanCosineIsOfAllVoxels)
{
  RefractiveMediumSettings settings = FogAround(12);
  settings.filterSize = 1;
  settings.outside.g = 0.9;
  settings.outside.sigma_s = {}; // what does not scatter has no say
  Solid ball = Ball();
  ball.material.g = 0.5;
  const RefractiveMedium clear = this->Made({ ball }, settings);
  EXPECT_EQ(clear.g, 0.5);
  EXPECT_THAT(clear.gByVoxel, IsEmpty());
}

TEST_F(RefractiveMediumTest, NoiseIsSeededBoundedAndInsideOnly)
{
  RefractiveMediumSettings settings = FogAround(32);
  settings.filterSize = 1;
  settings.perturbation = { 0.1, 0.5, 0.2, 7 };
  const Solid box = { "Box", shapes::Box({ -0.75, -0.75, -0.75 }, { 0.75, 0.75, 0.75 }), Glass() };
  const RefractiveMedium medium = this->Made({ box }, settings);
  double lowest = 2.0, highest = 0.0, sum = 0.0, steepest = 0.0;
  int inside = 0;
  for (std::size_t i = 0; i < medium.ior.size(); ++i)
  {
    if (medium.occupancy[i] < 1.0f)
    {
      ASSERT_EQ(medium.ior[i], 1.0f);
      ASSERT_EQ(medium.sigma_s[i], 0.7f);
      continue;
    }
    lowest = std::min<double>(lowest, medium.ior[i]);
    highest = std::max<double>(highest, medium.ior[i]);
    sum += medium.ior[i];
    ++inside;
    ASSERT_NEAR(medium.sigma_s[i] / 0.3, 1.0 + 5.0 * (medium.ior[i] - 1.5), 1e-5); // the same noise
    if (medium.occupancy[i + 1] == 1.0f)
    {
      steepest = std::max<double>(steepest, std::abs(medium.ior[i + 1] - medium.ior[i]));
    }
  }
  EXPECT_GE(lowest, 1.4);
  EXPECT_LE(highest, 1.6);
  EXPECT_LT(lowest, 1.45);
  EXPECT_GT(highest, 1.55);
  EXPECT_NEAR(sum / inside, 1.5, 0.01);
  EXPECT_LT(steepest, 0.1); // features are three voxels wide: no jumps

  EXPECT_EQ(this->Made({ box }, settings).ior, medium.ior);
  settings.perturbation.seed = 8;
  EXPECT_NE(this->Made({ box }, settings).ior, medium.ior);
}

TEST_F(RefractiveMediumTest, GradientOfAGlassBallPointsInwards)
{
  const RefractiveMediumSettings settings = FogAround(32);
  const RefractiveMedium medium = this->Made({ Ball() }, settings);
  double across = 0.0;
  for (int x = 16; x < 32; ++x) // from about the centre outwards
  {
    const std::size_t voxel = static_cast<std::size_t>((16 * 32 + 16) * 32 + x);
    across += medium.iorGradient[3 * voxel] * settings.grid.spacing[0];
    EXPECT_LE(medium.iorGradient[3 * voxel], 1e-6f);
  }
  EXPECT_NEAR(across, 1.0 - 1.5, 1e-3); // its integral is the step of n
}

TEST_F(RefractiveMediumTest, OddMeshesGiveWarnings)
{
  const auto warnings = [&](const TriangleMesh& mesh) {
    return this->Made({ { "Mesh", mesh, Glass() } }, FogAround()).warnings;
  };
  const TriangleMesh large = shapes::Sphere({ 0, 0, 0 }, 0.8, 4);
  const TriangleMesh small = shapes::Sphere({ 0.5, 0, 0 }, 0.4, 4);
  EXPECT_THAT(warnings(large), IsEmpty());
  EXPECT_THAT(warnings(shapes::Inverted(large)), ElementsAre(HasSubstr("Mesh is inverted")));
  EXPECT_THAT(warnings(shapes::Collective(large, small)),
    ElementsAre(testing::AllOf(HasSubstr("intersects itself"), HasSubstr("but from 0 to 2 times"))));
  TriangleMesh turned = large;
  std::swap(turned.triangles[3][0], turned.triangles[3][1]);
  EXPECT_THAT(warnings(turned), ElementsAre(HasSubstr("at 3 edges")));
  TriangleMesh degenerate = large;
  degenerate.triangles.push_back({ 7, 7, 8 });
  EXPECT_THAT(
    warnings(degenerate), ElementsAre(HasSubstr("1 triangle without area (degenerate), the first is number 2048")));
}

TEST_F(RefractiveMediumTest, IntersectionsThinnerThanAVoxelGiveAWarning)
{
  // Two unit boxes that overlap by 0.04: no voxel's centre is where they do, but a sample of four is.
  const Solid boxes = { "Mesh",
    shapes::Collective(shapes::Box({ 0, 0, 0 }, { 1, 1, 1 }), shapes::Box({ 0.96, 0, 0 }, { 1.9, 1, 1 })), Glass() };
  for (int size : { 8, 12, 16, 24, 32, 48 })
  {
    RefractiveMediumSettings settings = FogAround();
    settings.filterSize = 1;
    settings.grid.size = { 2 * size, size, size };
    settings.grid.spacing = { 2.0 / (2 * size), 1.2 / size, 1.2 / size };
    settings.grid.origin = { -0.05, -0.1, -0.1 };
    EXPECT_THAT(this->Made({ boxes }, settings).warnings, ElementsAre(HasSubstr("Mesh intersects itself"))) << size;
  }
}

TEST_F(RefractiveMediumTest, MemoryDoesNotGrowWithTheNumberOfSolids)
{
  RefractiveMediumSettings settings = FogAround(96);
  settings.voxelization.slabBytes = std::size_t(1) << 20;
  const auto peak = [&](int count) {
    std::vector<Solid> solids;
    for (int i = 0; i < count; ++i)
    {
      solids.push_back({ "Box", shapes::TurnedBox({ -0.5, -0.4, -0.3 }, { 0.5, 0.4, 0.1 * i }), Glass() });
    }
    this->GetDevice().ResetPeak();
    const std::size_t before = this->GetDevice().PeakBytes();
    this->Made(solids, settings);
    return this->GetDevice().PeakBytes() - before;
  };
  EXPECT_LT(peak(10), peak(2) + 10000);
}

TEST_F(RefractiveMediumTest, WhatDoesNotFitIsRefusedAtOnce)
{
  const auto complaint = [&](int size) {
    RefractiveMediumSettings settings = FogAround(24);
    settings.grid.size = { size, size, size };
    return ErrorWords<DeviceError>([&] { this->Made({ Ball() }, settings); });
  };
  for (int size : { 4000, 100000, 2000000000 })
  {
    const std::string number = std::to_string(size);
    EXPECT_THAT(complaint(size), HasSubstr("A box of " + number + " x " + number + " x " + number + " voxels"));
    EXPECT_THAT(complaint(size), HasSubstr("28 bytes each"));
    EXPECT_THAT(complaint(size), HasSubstr("Ask for fewer voxels"));
  }
  EXPECT_THAT(complaint(4000), HasSubstr(" needs ")) << "bytes";
  EXPECT_EQ(complaint(24), "");
}

TEST_F(RefractiveMediumTest, LengthsBeyondSinglePrecisionAreRefused)
{
  for (double scale : { 1e-30, 1e30 })
  {
    Solid ball = Ball();
    for (shapes::Point& point : ball.mesh.points)
    {
      for (double& coordinate : point)
      {
        coordinate *= scale;
      }
    }
    RefractiveMediumSettings settings = FogAround(12);
    settings.grid = CubeGrid(12, -scale, scale);
    this->ExpectRefused({ ball }, settings, "se another unit of length");
  }
}

TEST_F(RefractiveMediumTest, OpenMeshesAreRefused)
{
  Solid open = Ball();
  open.mesh.triangles.pop_back();
  this->ExpectRefused({ Ball(), open }, FogAround(), "Ball is open: it has 3 boundary edges");
  open.mesh.triangles.pop_back();
  this->ExpectRefused({ open }, FogAround(), "the first from (");

  // Seams far narrower than a sample are no holes.
  Solid seam = Ball();
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> anywhere(-1e-12, 1e-12);
  for (shapes::Point& point : seam.mesh.points)
  {
    for (double& coordinate : point)
    {
      coordinate = std::round(coordinate * 1e3) / 1e3 + anywhere(generator);
    }
  }
  EXPECT_GT(Examine(seam.mesh).boundaryEdges, 1000u);
  EXPECT_NO_THROW(this->Made({ seam }, FogAround()));
}

TEST(GridAround, HasCubesAndRoomForTheFilter)
{
  const Solid plate = { "Plate", shapes::Box({ 1, 2, 3 }, { 9, 4, 4 }), {} };
  const Grid grid = GridAround({ plate }, { 200, 200, 100 }, 0.1, 9);
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_DOUBLE_EQ(grid.spacing[axis], (8.0 + 2 * 0.8) / 200);
    EXPECT_DOUBLE_EQ(
      grid.origin[axis] + 0.5 * grid.Length(axis), 0.5 * (plate.mesh.points[0][axis] + plate.mesh.points[7][axis]));
  }
  EXPECT_DOUBLE_EQ(GridAround({ plate }, { 40, 40, 20 }, 0.0, 9).spacing[0], 8.0 / (40 - 2 * 5));
  EXPECT_DOUBLE_EQ(GridAround({ plate }, { 40, 40, 20 }, 0.0, 1).spacing[0], 8.0 / (40 - 2));
  EXPECT_DOUBLE_EQ(GridAround({ plate }, { 4, 4, 4 }, 0.0, 9).spacing[0], 2.0); // no room at all
  EXPECT_THROW(GridAround({ plate }, { 4, 0, 4 }, 0.1, 9), InvalidInput);
  EXPECT_THROW(GridAround({ plate }, { 4, 4, 4 }, -0.1, 9), InvalidInput);
  EXPECT_THROW(GridAround({}, { 4, 4, 4 }, 0.1, 9), InvalidInput);
}

TEST(GridAround, NamesWhatIsWrongWithAMesh)
{
  const auto complaint = [](const TriangleMesh& mesh) {
    return ErrorWords([&] { GridAround({ { "Mesh 2", mesh, {} } }, { 8, 8, 8 }, 0.1, 9); });
  };
  for (double wrong : { HUGE_VAL, -HUGE_VAL, std::nan("") })
  {
    TriangleMesh mesh = shapes::Box({ 0, 0, 0 }, { 1, 1, 1 });
    mesh.points[3][1] = wrong;
    EXPECT_THAT(complaint(mesh), HasSubstr("Mesh 2 cannot be used. Point 3 of the mesh is at (1, "));
    mesh.pointNumbers = { 5, 6, 7, 88, 9, 10, 11, 12 };
    EXPECT_THAT(complaint(mesh), HasSubstr("Point 88 of the mesh"));
  }
  EXPECT_THAT(complaint({}), HasSubstr("There is no mesh, or none with an extent"));
  EXPECT_THAT(complaint({}), HasSubstr("Mesh 2 has 0 triangles and 0 boundary edges"));
  TriangleMesh point = shapes::Box({ 1, 2, 3 }, { 1, 2, 3 });
  EXPECT_THAT(complaint(point), HasSubstr("Mesh 2 has 12 triangles and 0 boundary edges"));
}

TEST_F(RefractiveMediumTest, BadInputIsRefused)
{
  const RefractiveMediumSettings good = FogAround(8);
  this->ExpectRefused({}, good, "There is no mesh");
  this->ExpectRefused({ { "Input 1", {}, Glass() } }, good, "Input 1 cannot be used. The mesh is empty");
  Solid flat = Ball();
  for (shapes::Point& point : flat.mesh.points)
  {
    point[1] = point[2] = 0.0;
  }
  this->ExpectRefused({ flat }, good, "no volume");
  flat.mesh = { { { 0, 0, 0 }, { 1, 1, 1 }, { 2, 2, 2 } }, { { 0, 1, 2 } }, {} };
  this->ExpectRefused({ flat }, good, "1 triangle, all without area (degenerate), and 3 boundary edges");

  const Solid endless = { "Bar", shapes::Box({ -0.5, -0.5, -0.5 }, { 0.5, 0.5, 1e6 }), Glass() };
  this->ExpectRefused({ endless }, good, "With 4 samples an edge of a voxel it can be 131072 at most");

  RefractiveMediumSettings bad = good;
  bad.filterSize = 4;
  this->ExpectRefused({ Ball() }, bad, "odd number");
  bad = good;
  bad.outside.n = 0.0;
  this->ExpectRefused({ Ball() }, bad, "The outside has the refractive index");
  bad = good;
  bad.outside.g = 0.99999999999; // 1 as a float
  this->ExpectRefused({ Ball() }, bad, "mean cosine");
  bad = good;
  bad.grid.size[1] = 0;
  this->ExpectRefused({ Ball() }, bad, "no voxels along y");
  bad = good;
  bad.perturbation.index = 1.5;
  this->ExpectRefused({ Ball() }, bad, "noise of the index");
  bad = good;
  bad.perturbation.size = 0.0;
  this->ExpectRefused({ Ball() }, bad, "noise's size");
  Solid ball = Ball();
  ball.material.sigma_s[1] = -1.0;
  this->ExpectRefused({ ball }, good, "Ball has an absorption or scattering coefficient");
}

class IndexFieldTest : public DeviceTest
{
};

/// The Gaussian as a sum over all of its voxels at once, in double.
double Smoothed(const std::vector<float>& n, const Grid& grid, int size, const std::array<int, 3>& voxel)
{
  const double deviation = size / 6.0;
  double sum = 0.0, weights = 0.0;
  for (int dz = -size / 2; dz <= size / 2; ++dz)
  {
    for (int dy = -size / 2; dy <= size / 2; ++dy)
    {
      for (int dx = -size / 2; dx <= size / 2; ++dx)
      {
        const double weight = std::exp(-0.5 * (dx * dx + dy * dy + dz * dz) / (deviation * deviation));
        const auto clamped = [&](int axis, int d) { return std::clamp(voxel[axis] + d, 0, grid.size[axis] - 1); };
        sum += weight *
          n[static_cast<std::size_t>((clamped(2, dz) * grid.size[1] + clamped(1, dy)) * grid.size[0] + clamped(0, dx))];
        weights += weight;
      }
    }
  }
  return sum / weights;
}

TEST_F(IndexFieldTest, SmoothingIsAGaussian)
{
  const Grid grid = { { 21, 7, 12 }, { 1, 1, 1 }, { 0, 0, 0 } };
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> index(1.0f, 2.0f);
  std::vector<float> n(grid.VoxelCount());
  std::generate(n.begin(), n.end(), [&] { return index(generator); });
  for (int size : { 3, 9, 15 })
  {
    Buffer<float> buffer(this->GetDevice(), n, "n");
    SmoothIndex(this->GetDevice(), grid, size, buffer);
    const std::vector<float> smooth = buffer.Read();
    for (std::size_t i = 0; i < n.size(); ++i)
    {
      const std::array<int, 3> voxel = { static_cast<int>(i % 21), static_cast<int>(i / 21 % 7),
        static_cast<int>(i / 147) };
      ASSERT_NEAR(smooth[i], Smoothed(n, grid, size, voxel), 2e-6) << size << " wide, voxel " << i;
    }
  }
}

TEST_F(IndexFieldTest, EvenIndexStaysToTheLastBit)
{
  const Grid grid = { { 19, 11, 10 }, { 1, 1, 1 }, { 0, 0, 0 } };
  const std::vector<float> n(grid.VoxelCount(), 1.33f);
  Buffer<float> buffer(this->GetDevice(), n, "n");
  SmoothIndex(this->GetDevice(), grid, 9, buffer);
  EXPECT_EQ(buffer.Read(), n);
}

TEST_F(IndexFieldTest, GradientOfALinearIndexIsExact)
{
  const Grid grid = { { 9, 5, 4 }, { 0.5, 0.25, 2.0 }, { 3, 4, 5 } };
  std::vector<float> n(grid.VoxelCount());
  for (std::size_t i = 0; i < n.size(); ++i)
  {
    n[i] = static_cast<float>(1.0 + 0.5 * (i % 9) * 0.125 + 0.25 * (i / 9 % 5) * 0.5 - 2.0 * (i / 45) * 0.0625);
  }
  const std::vector<float> gradient = IndexGradient(this->GetDevice(), grid, Buffer<float>(this->GetDevice(), n, "n"));
  for (std::size_t i = 0; i < n.size(); ++i)
  {
    ASSERT_FLOAT_EQ(gradient[3 * i], 0.125f);
    ASSERT_FLOAT_EQ(gradient[3 * i + 1], 0.5f);
    ASSERT_FLOAT_EQ(gradient[3 * i + 2], -0.0625f);
  }
}

TEST_F(IndexFieldTest, GradientAlongASingleVoxelIsZero)
{
  const Grid grid = { { 1, 1, 3 }, { 1, 1, 1 }, { 0, 0, 0 } };
  const std::vector<float> n = { 1.0f, 2.0f, 4.0f };
  EXPECT_THAT(IndexGradient(this->GetDevice(), grid, Buffer<float>(this->GetDevice(), n, "n")),
    ElementsAre(0.0f, 0.0f, 1.0f, 0.0f, 0.0f, 1.5f, 0.0f, 0.0f, 2.0f));
}
}
