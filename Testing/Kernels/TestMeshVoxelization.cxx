#include "DeviceTest.h"
#include "ErrorWords.h"
#include "MeshShapes.h"
#include "WholeCounts.h"

#include "Refraction/Voxelization/SampleLattice.h"
#include "Refraction/Voxelization/Voxelization.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace tyndall;
using shapes::CubeGrid;
using shapes::Point;

namespace
{
using Counts = std::vector<cl_ushort>;

class MeshVoxelization : public DeviceTest
{
protected:
  Counts Inside(const Grid& grid, const TriangleMesh& mesh, const VoxelizationSettings& settings = {})
  {
    return CountWhole(this->GetDevice(), grid, { { &mesh } }, settings).counts[0];
  }

  Counts Inside(const Grid& grid, const TriangleMesh& mesh, int samples)
  {
    VoxelizationSettings settings;
    settings.samples = samples;
    return this->Inside(grid, mesh, settings);
  }

  /// By samples alone, without fractions.
  Counts Samples(const Grid& grid, const TriangleMesh& mesh, int samples = 4)
  {
    VoxelizationSettings settings;
    settings.samples = samples;
    settings.fractions = false;
    Counts counts = this->Inside(grid, mesh, settings);
    for (cl_ushort& count : counts)
    {
      EXPECT_EQ(count % UnitsOfSample(samples), 0);
      count = static_cast<cl_ushort>(count / UnitsOfSample(samples));
    }
    return counts;
  }

  double Volume(const Grid& grid, const TriangleMesh& mesh, int samples = 4)
  {
    const Counts counts = this->Inside(grid, mesh, samples);
    const double sum = std::accumulate(counts.begin(), counts.end(), 0.0);
    return sum * grid.VoxelVolume() / (samples * samples * samples * UnitsOfSample(samples));
  }

  void ExpectSameFromAllSides(const Grid& grid, const TriangleMesh& mesh, int samples)
  {
    VoxelizationSettings settings;
    settings.samples = samples;
    for (bool fractions : { false, true })
    {
      settings.fractions = fractions;
      settings.columnAxis = 0;
      const Counts first = this->Inside(grid, mesh, settings);
      EXPECT_GT(std::accumulate(first.begin(), first.end(), 0.0), 0.0);
      for (int axis = 0; axis < 3; ++axis)
      {
        settings.columnAxis = axis;
        EXPECT_TRUE(this->Inside(grid, mesh, settings) == first)
          << samples << " samples, axis " << axis << (fractions ? ", with fractions" : "");
      }
    }
  }
};

/// How often a mesh winds about a point, from the solid angles of its triangles (Van Oosterom and Strackee 1983): a
/// reference that knows no columns.
double Winding(const TriangleMesh& mesh, const Point& centre)
{
  const auto dot = [](const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  double angle = 0.0;
  for (const auto& triangle : mesh.triangles)
  {
    std::array<Point, 3> r;
    std::array<double, 3> length;
    for (int c = 0; c < 3; ++c)
    {
      const Point& p = mesh.points[static_cast<std::size_t>(triangle[c])];
      r[c] = { p[0] - centre[0], p[1] - centre[1], p[2] - centre[2] };
      length[c] = std::sqrt(dot(r[c], r[c]));
    }
    const auto& [a, b, c] = r;
    const double box =
      a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
    angle += 2.0 *
      std::atan2(
        box, length[0] * length[1] * length[2] + dot(a, b) * length[2] + dot(b, c) * length[0] + dot(c, a) * length[1]);
  }
  return angle / (4.0 * shapes::Pi);
}

/// A closed mesh as rough as can be: a torus whose points are thrown about.
TriangleMesh RoughTorus(unsigned seed, double roughness)
{
  TriangleMesh mesh = shapes::Torus({ 0.02, -0.03, 0.01 }, 0.6, 0.25, 24, 12);
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> anywhere(-roughness, roughness);
  for (Point& point : mesh.points)
  {
    for (double& coordinate : point)
    {
      coordinate += anywhere(generator);
    }
  }
  return mesh;
}

/// Points on the lattice of sample points of CubeGrid(16) with 4 samples, so that nothing but ties is left.
TriangleMesh OnSamples(TriangleMesh mesh)
{
  const double pitch = 2.0 / 64.0;
  for (Point& point : mesh.points)
  {
    for (double& coordinate : point)
    {
      coordinate = (std::floor(coordinate / pitch) + 0.5) * pitch;
    }
  }
  return mesh;
}

TEST_F(MeshVoxelization, SphereHasItsVolume)
{
  const double exact = 4.0 / 3.0 * shapes::Pi * 0.8 * 0.8 * 0.8;
  EXPECT_NEAR(this->Volume(CubeGrid(64), shapes::Sphere({ 0.01, 0.02, -0.03 }, 0.8)), exact, 1e-3 * exact);
}

TEST_F(MeshVoxelization, TorusHasItsVolume)
{
  const double exact = 2.0 * shapes::Pi * shapes::Pi * 0.6 * 0.25 * 0.25;
  EXPECT_NEAR(this->Volume(CubeGrid(64), shapes::Torus({ 0.01, 0.02, -0.03 }, 0.6, 0.25)), exact, 1e-3 * exact);
}

TEST_F(MeshVoxelization, TurnedBoxHasItsVolume)
{
  EXPECT_NEAR(this->Volume(CubeGrid(64), shapes::TurnedBox({ -0.5, -0.4, -0.6 }, { 0.5, 0.4, 0.6 })), 0.96, 5e-4);
}

TEST_F(MeshVoxelization, BoxOnVoxelsIsExact)
{
  const Grid grid = { { 9, 10, 11 }, { 0.5, 0.25, 1.0 }, { -3.0, 7.0, 0.0 } };
  const Counts counts = this->Inside(grid, shapes::Box({ -2.0, 7.5, 1.0 }, { 0.5, 9.0, 10.0 }));
  for (std::size_t voxel = 0; voxel < counts.size(); ++voxel)
  {
    const std::size_t x = voxel % 9, y = voxel / 9 % 10, z = voxel / 90;
    const bool inside = x >= 2 && x < 7 && y >= 2 && y < 8 && z >= 1 && z < 10;
    ASSERT_EQ(counts[voxel], inside ? 64 * UnitsOfSample(4) : 0) << x << " " << y << " " << z;
  }
}

TEST_F(MeshVoxelization, SamplesOnFacesCountOnce)
{
  // Every face runs through samples; of two opposite faces one has them.
  const TriangleMesh box = OnSamples(shapes::Box({ -0.5, -0.5, -0.5 }, { 0.5, 0.5, 0.5 }));
  const Counts counts = this->Samples(CubeGrid(16), box);
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), 32 * 32 * 32);
}

TEST_F(MeshVoxelization, ErrorOfOccupancyFallsWithTheFactor)
{
  const Grid grid = CubeGrid(32);
  const TriangleMesh sphere = shapes::Sphere({ 0.01, 0.02, -0.03 }, 0.8);
  const Counts fine = this->Inside(grid, sphere, 16);
  std::vector<double> error;
  for (int samples : { 1, 2, 4, 8 })
  {
    const Counts counts = this->Inside(grid, sphere, samples);
    double sum = 0.0;
    for (std::size_t i = 0; i < counts.size(); ++i)
    {
      const double difference =
        counts[i] / (std::pow(samples, 3.0) * UnitsOfSample(samples)) - fine[i] / (4096.0 * UnitsOfSample(16));
      sum += difference * difference;
    }
    error.push_back(std::sqrt(sum / counts.size()));
  }
  for (std::size_t k = 1; k < error.size(); ++k)
  {
    EXPECT_LT(error[k], 0.55 * error[k - 1]); // the part of samples near the border halves, and their errors cancel
  }
}

TEST_F(MeshVoxelization, AgreesWithSolidAngles)
{
  const Grid grid = { { 13, 11, 9 }, { 0.17, 0.2, 0.25 }, { -1.1, -1.1, -1.1 } };
  for (unsigned seed : { 1u, 2u, 3u })
  {
    const TriangleMesh mesh = RoughTorus(seed, 0.1);
    const Counts counts = this->Samples(grid, mesh, 1);
    for (std::size_t voxel = 0; voxel < counts.size(); ++voxel)
    {
      const Point centre = { grid.origin[0] + (voxel % 13 + 0.5) * 0.17, grid.origin[1] + (voxel / 13 % 11 + 0.5) * 0.2,
        grid.origin[2] + (voxel / 143 + 0.5) * 0.25 };
      const int winding = static_cast<int>(std::lround(Winding(mesh, centre)));
      ASSERT_EQ(counts[voxel], winding & 1) << "seed " << seed << ", voxel " << voxel << ", winding " << winding;
    }
  }
}

TEST_F(MeshVoxelization, IsTheSameFromAllSides)
{
  const Grid grid = { { 37, 22, 29 }, { 0.055, 0.09, 0.07 }, { -1.0, -0.95, -1.05 } };
  for (int samples : { 1, 3, 4, 16 })
  {
    this->ExpectSameFromAllSides(grid, RoughTorus(5, 0.1), samples);
  }
}

TEST_F(MeshVoxelization, IsTheSameFromAllSidesWhereEverythingIsATie)
{
  const Grid grid = CubeGrid(16);
  this->ExpectSameFromAllSides(grid, OnSamples(RoughTorus(7, 0.1)), 4);
  this->ExpectSameFromAllSides(grid, OnSamples(shapes::Sphere({ 0, 0, 0 }, 0.8, 3)), 4);
  this->ExpectSameFromAllSides(grid, OnSamples(shapes::Torus({ 0, 0, 0 }, 0.6, 0.3, 16, 8)), 4);
  this->ExpectSameFromAllSides(grid, OnSamples(shapes::Box({ -0.5, -0.7, -0.2 }, { 0.5, 0.5, 0.5 })), 4);
}

TEST_F(MeshVoxelization, IsTheSameFromAllSidesForMeshesThatStickOut)
{
  this->ExpectSameFromAllSides(CubeGrid(21, 0.0, 0.7), RoughTorus(9, 0.05), 4);
  this->ExpectSameFromAllSides(CubeGrid(8, -0.1, 0.2), shapes::Sphere({ 0.3, 0.1, 0.2 }, 0.4), 4);
}

TEST_F(MeshVoxelization, IsTheSameInSlabs)
{
  const Grid grid = CubeGrid(30);
  VoxelizationSettings settings;
  const Counts whole = this->Inside(grid, RoughTorus(3, 0.1), settings);
  settings.slabBytes = 1;
  EXPECT_TRUE(this->Inside(grid, RoughTorus(3, 0.1), settings) == whole);
  settings.slabBytes = 100000;
  EXPECT_TRUE(this->Inside(grid, RoughTorus(3, 0.1), settings) == whole);
  settings.columnAxis = 2; // whose slabs are not layers of the grid
  EXPECT_TRUE(this->Inside(grid, RoughTorus(3, 0.1), settings) == whole);
}

TEST_F(MeshVoxelization, FineGridIsBounded)
{
  // As a whole it would take 16 MB, the counts of its voxels 4 MB, and their fractions of samples 8 MB.
  const Grid grid = CubeGrid(128);
  VoxelizationSettings settings;
  settings.slabBytes = std::size_t(1) << 20;
  Device& device = this->GetDevice();
  device.ResetPeak();
  const std::size_t before = device.PeakBytes();
  this->Inside(grid, shapes::Torus({ 0, 0, 0 }, 0.6, 0.25), settings);
  EXPECT_LT(device.PeakBytes() - before, std::size_t(6) << 20);
}

TEST_F(MeshVoxelization, LargeTrianglesAreAsManySmallOnes)
{
  // The box's twelve triangles are split into many tiles; those of its division are one each.
  const TriangleMesh box = shapes::Box({ -0.875, -0.75, -0.625 }, { 0.875, 0.5, 0.75 });
  TriangleMesh divided = box;
  for (int d = 0; d < 5; ++d)
  {
    TriangleMesh finer;
    finer.points = divided.points;
    for (const auto& [a, b, c] : divided.triangles)
    {
      std::array<int, 3> middle;
      const std::array<int, 3> corner = { a, b, c };
      for (std::size_t side = 0; side < 3; ++side)
      {
        const Point& p = divided.points[static_cast<std::size_t>(corner[side])];
        const Point& q = divided.points[static_cast<std::size_t>(corner[(side + 1) % 3])];
        middle[side] = static_cast<int>(finer.points.size());
        finer.points.push_back({ 0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1]), 0.5 * (p[2] + q[2]) });
      }
      finer.triangles.insert(finer.triangles.end(),
        { { a, middle[0], middle[2] }, { middle[0], b, middle[1] }, { middle[2], middle[1], c }, middle });
    }
    divided = std::move(finer);
  }
  EXPECT_TRUE(this->Inside(CubeGrid(100), box) == this->Inside(CubeGrid(100), divided));
}

TEST_F(MeshVoxelization, TilesAreSmallAndFollowTheTriangle)
{
  // A sliver across a grid of 1024^2 columns: the box about it has 1024 tiles.
  const Grid grid = CubeGrid(256);
  TriangleMesh sliver;
  sliver.points = { { 0, -0.99, -0.99 }, { 0.1, 0.99, 0.98 }, { 0, 0.98, 0.99 } };
  sliver.triangles = { { 0, 1, 2 } };
  const SampleLattice lattice(grid, 4, { &sliver });
  const SampleColumns columns(grid, 0, 4, lattice.Pitch());
  const std::vector<cl_uint4> tiles = LatticeMesh(this->GetDevice(), lattice, sliver).Tiles(columns, 0, 1024);
  EXPECT_LE(tiles.size(), 130u);
  for (const cl_uint4& tile : tiles)
  {
    EXPECT_LE((tile.s[3] >> 16) * (tile.s[3] & 0xffff), 1024u);
  }
}

TEST_F(MeshVoxelization, LaterMeshesWin)
{
  const Grid grid = CubeGrid(20);
  const TriangleMesh sphere = shapes::Sphere({ 0, 0, 0 }, 0.8, 4);
  const TriangleMesh box = shapes::TurnedBox({ -0.3, -0.3, -0.3 }, { 0.9, 0.3, 0.3 });
  const auto both = CountWhole(this->GetDevice(), grid, { { &sphere }, { &box } }).counts;
  const Counts& ofSphere = both[0];
  const Counts& ofBox = both[1];
  EXPECT_TRUE(ofBox == this->Inside(grid, box));
  const Counts alone = this->Inside(grid, sphere);
  const int whole = 64 * UnitsOfSample(4);
  bool shared = false;
  for (std::size_t i = 0; i < alone.size(); ++i)
  {
    ASSERT_LE(ofSphere[i], alone[i]);
    ASSERT_LE(ofSphere[i] + ofBox[i], whole);
    if (alone[i] == whole)
    {
      ASSERT_EQ(ofSphere[i] + ofBox[i], whole); // nothing gets lost between them
      shared = shared || (ofSphere[i] > 0 && ofBox[i] > 0);
    }
  }
  EXPECT_TRUE(shared);
}

TEST_F(MeshVoxelization, MeshesThatTouchShareTheirBorder)
{
  // A cut at an odd place and angle, the same points on both sides: each sample belongs to one of them.
  const TriangleMesh whole = shapes::Box({ -0.8, -0.8, -0.8 }, { 0.8, 0.8, 0.8 });
  const auto part = [](bool upper) {
    TriangleMesh mesh = shapes::Box({ -0.8, -0.8, -0.8 }, { 0.8, 0.8, 0.8 });
    const double cut[4] = { -0.123, 0.321, 0.057, 0.501 };
    for (int k = 0; k < 4; ++k)
    {
      mesh.points[static_cast<std::size_t>(upper ? k : k + 4)][2] = cut[k];
    }
    return mesh;
  };
  const TriangleMesh lower = part(false);
  TriangleMesh upper = part(true);
  upper.triangles[0] = { 0, 2, 1 }; // the diagonal of the other side
  upper.triangles[1] = { 1, 2, 3 };
  TriangleMesh lowerSameDiagonal = lower;
  lowerSameDiagonal.triangles[2] = { 4, 5, 6 };
  lowerSameDiagonal.triangles[3] = { 5, 7, 6 };
  const Counts all = this->Samples(CubeGrid(24), whole);
  const Counts below = this->Samples(CubeGrid(24), lowerSameDiagonal);
  const Counts above = this->Samples(CubeGrid(24), upper);
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    ASSERT_EQ(below[i] + above[i], all[i]) << i;
  }
}

TEST_F(MeshVoxelization, RefusesSettingsWithoutMeaning)
{
  const TriangleMesh box = shapes::Box({ -0.5, -0.5, -0.5 }, { 0.5, 0.5, 0.5 });
  EXPECT_THROW(this->Inside(CubeGrid(4), box, 0), InvalidInput);
  EXPECT_THROW(this->Inside(CubeGrid(4), box, 17), InvalidInput);
  const TriangleMesh huge = shapes::Box({ -1e9, -0.5, -0.5 }, { 1e9, 0.5, 0.5 });
  const std::string words = ErrorWords([&] { this->Inside(CubeGrid(4), huge); });
  EXPECT_THAT(words, testing::HasSubstr("voxels long"));
}

TEST_F(MeshVoxelization, CanBeStopped)
{
  VoxelizationSettings settings;
  settings.slabBytes = 1;
  int calls = 0;
  const TriangleMesh sphere = shapes::Sphere({ 0, 0, 0 }, 0.8, 3);
  EXPECT_THROW(CountWhole(this->GetDevice(), CubeGrid(16), { { &sphere } }, settings,
                 [&](double done) {
                   EXPECT_LE(done, 1.0);
                   return ++calls < 5;
                 }),
    Aborted);
  EXPECT_EQ(calls, 5);
}

class Windings : public MeshVoxelization
{
protected:
  WindingNumbers Of(const Grid& grid, const TriangleMesh& mesh, int orientation = 1, int samples = 1)
  {
    VoxelizationSettings settings;
    settings.samples = samples;
    return CountWhole(this->GetDevice(), grid, { { &mesh, orientation } }, settings).windings[0];
  }
};

TEST_F(Windings, OfNestedAndOverlappingMeshes)
{
  const Grid grid = CubeGrid(32);
  const TriangleMesh large = shapes::Sphere({ 0, 0, 0 }, 0.8, 4);
  const TriangleMesh small = shapes::Sphere({ 0.1, 0, 0 }, 0.4, 4);
  EXPECT_EQ(this->Of(grid, large).oddSamples, 0u);

  const WindingNumbers twice = this->Of(grid, shapes::Collective(large, small));
  const Counts inSmall = this->Samples(grid, small, 1);
  EXPECT_EQ(twice.lowest, 0);
  EXPECT_EQ(twice.highest, 2);
  EXPECT_EQ(twice.oddSamples, static_cast<std::size_t>(std::count(inSmall.begin(), inSmall.end(), 1)));
  std::size_t first = 0;
  for (int axis = 2; axis >= 0; --axis)
  {
    first = 32 * first + static_cast<std::size_t>((twice.firstOddSample[axis] + 1.0) * 16.0);
  }
  EXPECT_EQ(first, static_cast<std::size_t>(std::find(inSmall.begin(), inSmall.end(), 1) - inSmall.begin()));

  EXPECT_EQ(this->Of(grid, shapes::Collective(large, shapes::Inverted(small))).oddSamples, 0u); // a hollow ball
  EXPECT_EQ(this->Of(grid, shapes::Inverted(large)).lowest, -1);
  EXPECT_EQ(this->Of(grid, shapes::Inverted(large), -1).oddSamples, 0u);
  EXPECT_EQ(this->Of(grid, shapes::Inverted(large), 0).oddSamples, 0u); // not looked for
}

TEST_F(Windings, AreThoseOfSolidAngles)
{
  const Grid grid = { { 13, 11, 9 }, { 0.17, 0.2, 0.25 }, { -1.1, -1.1, -1.1 } };
  for (unsigned seed : { 1u, 2u, 3u })
  {
    const TriangleMesh mesh = RoughTorus(seed, 0.3);
    WindingNumbers expected;
    for (std::size_t voxel = 0; voxel < grid.VoxelCount(); ++voxel)
    {
      const Point centre = { grid.origin[0] + (voxel % 13 + 0.5) * 0.17, grid.origin[1] + (voxel / 13 % 11 + 0.5) * 0.2,
        grid.origin[2] + (voxel / 143 + 0.5) * 0.25 };
      const int winding = static_cast<int>(std::lround(Winding(mesh, centre)));
      expected.oddSamples += winding != 0 && winding != 1;
      expected.lowest = std::min(expected.lowest, winding);
      expected.highest = std::max(expected.highest, winding);
    }
    const WindingNumbers found = this->Of(grid, mesh);
    EXPECT_GT(expected.oddSamples, 0u);
    EXPECT_EQ(found.oddSamples, expected.oddSamples);
    EXPECT_EQ(found.lowest, expected.lowest);
    EXPECT_EQ(found.highest, expected.highest);
  }
}

TEST_F(Windings, OfWhatIsThinnerThanAVoxel)
{
  // Two boxes that share a layer of one sample of four, between the voxels' centres; then one that shares a single
  // sample.
  const Grid grid = CubeGrid(16);
  const double pitch = 2.0 / 64.0;
  const TriangleMesh left = shapes::Box({ -0.75, -0.5, -0.5 }, { pitch, 0.5, 0.5 });
  for (int axis = 0; axis < 3; ++axis)
  {
    VoxelizationSettings settings;
    settings.columnAxis = axis;
    const auto odd = [&](const TriangleMesh& mesh) {
      return CountWhole(this->GetDevice(), grid, { { &mesh } }, settings).windings[0].oddSamples;
    };
    EXPECT_EQ(odd(shapes::Collective(left, shapes::Box({ 0.0, -0.5, -0.5 }, { 0.75, 0.5, 0.5 }))), 32u * 32u);
    EXPECT_EQ(odd(shapes::Collective(left, shapes::Box({ 0.0, 0.5 - pitch, 0.5 - pitch }, { 0.75, 0.9, 0.9 }))), 1u);
    EXPECT_EQ(odd(shapes::Collective(left, shapes::Box({ pitch, -0.5, -0.5 }, { 0.75, 0.5, 0.5 }))), 0u); // they touch
  }
}

TEST_F(Windings, ThatBalanceAreFound)
{
  // In each column of y and z as many samples are enclosed twice as are inside out: what parity leaves out here it adds
  // there.
  const Grid grid = CubeGrid(16);
  const TriangleMesh twice = shapes::Collective(
    shapes::Box({ -0.9, -0.5, -0.5 }, { -0.2, 0.5, 0.5 }), shapes::Box({ -0.7, -0.5, -0.5 }, { -0.5, 0.5, 0.5 }));
  const TriangleMesh inverted = shapes::Inverted(shapes::Box({ 0.5, -0.5, -0.5 }, { 0.7, 0.5, 0.5 }));
  EXPECT_GT(this->Of(grid, shapes::Collective(twice, inverted), 1, 4).oddSamples, 0u);
}
}
