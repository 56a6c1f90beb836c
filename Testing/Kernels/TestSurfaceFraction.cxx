// Occupancy to a fraction of a sample: no terraces, and as symmetric as samples are.
#include "DeviceTest.h"
#include "MeshShapes.h"
#include "WholeCounts.h"

#include <algorithm>
#include <cmath>
#include <random>

using namespace tyndall;
using shapes::CubeGrid;
using shapes::Point;

namespace
{
/// A closed mesh without symmetry, whose points are nowhere near the middle between two of the lattice.
TriangleMesh RoughTorus(double roughness = 0.1)
{
  TriangleMesh mesh = shapes::Torus({ 0.0, 0.0, 0.0 }, 0.6, 0.25, 24, 12);
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> anywhere(-roughness, roughness);
  for (Point& point : mesh.points)
  {
    for (double& coordinate : point)
    {
      coordinate = std::round((coordinate + anywhere(generator)) * 8192.0) / 8192.0;
    }
  }
  return mesh;
}

class SurfaceFractionTest : public DeviceTest
{
protected:
  std::vector<std::vector<double>> Parts(
    const Grid& grid, const std::vector<OrientedMesh>& meshes, int samples = 4, bool fractions = true)
  {
    VoxelizationSettings settings;
    settings.samples = samples;
    settings.fractions = fractions;
    std::vector<std::vector<double>> parts;
    for (const std::vector<cl_ushort>& counts : CountWhole(this->GetDevice(), grid, meshes, settings).counts)
    {
      parts.emplace_back(counts.begin(), counts.end());
      for (double& part : parts.back())
      {
        part /= samples * samples * samples * UnitsOfSample(samples);
      }
    }
    return parts;
  }

  std::vector<double> Occupancy(const Grid& grid, const TriangleMesh& mesh, int samples = 4, bool fractions = true)
  {
    return this->Parts(grid, { { &mesh } }, samples, fractions)[0];
  }

  /// Relative, of the volume.
  double VolumeError(const Grid& grid, const TriangleMesh& mesh, int samples, bool fractions)
  {
    const double exact = Examine(mesh).enclosedVolume;
    double sum = 0.0;
    for (const double part : this->Occupancy(grid, mesh, samples, fractions))
    {
      sum += part;
    }
    return sum * grid.VoxelVolume() / exact - 1.0;
  }
};

/// Its upper face rises by `slope` along `along`, 0 or 1, from 0.013 in the middle.
TriangleMesh Ramp(double slope, int along)
{
  TriangleMesh mesh = shapes::Box({ -3.0, -3.0, -3.0 }, { 3.0, 3.0, 0.0 });
  for (std::size_t corner = 4; corner < 8; ++corner)
  {
    mesh.points[corner][2] = 0.013 + slope * mesh.points[corner][along];
  }
  return mesh;
}

/// Largest difference between what a ramp fills of a column of voxels, voxels, and what it should.
double Terraces(const Grid& grid, const std::vector<double>& occupancy, double slope, int along)
{
  double largest = 0.0;
  for (int i = 0; i < grid.size[along]; ++i)
  {
    const int x = along == 0 ? i : 5, y = along == 1 ? i : 5;
    double height = 0.0;
    for (int z = 0; z < grid.size[2]; ++z)
    {
      height += occupancy[static_cast<std::size_t>((z * grid.size[1] + y) * grid.size[0] + x)];
    }
    const double middle = grid.origin[along] + (i + 0.5) * grid.spacing[along];
    largest = std::max(largest, std::abs(height - (0.013 + slope * middle - grid.origin[2]) / grid.spacing[2]));
  }
  return largest;
}

TEST_F(SurfaceFractionTest, APlaneNearlyParallelToVoxelsHasNoTerraces)
{
  const Grid grid = CubeGrid(64);
  for (int along : { 0, 1 })
  {
    for (double slope : { 0.01, -0.03, 0.1, 0.3 })
    {
      const TriangleMesh ramp = Ramp(slope, along);
      EXPECT_LT(Terraces(grid, this->Occupancy(grid, ramp), slope, along), slope == 0.3 ? 2e-2 : 1e-3) << slope;
      EXPECT_GT(Terraces(grid, this->Occupancy(grid, ramp, 4, false), slope, along), 0.04) << slope; // by samples alone
    }
  }
}

TEST_F(SurfaceFractionTest, IsOneAndZeroAwayFromTheSurface)
{
  const Grid grid = CubeGrid(24);
  const TriangleMesh mesh = RoughTorus();
  const std::vector<double> samples = this->Occupancy(grid, mesh, 16, false);
  const std::vector<double> parts = this->Occupancy(grid, mesh);
  int whole = 0;
  for (std::size_t i = 0; i < parts.size(); ++i)
  {
    ASSERT_GE(parts[i], 0.0);
    ASSERT_LE(parts[i], 1.0);
    if (samples[i] == 0.0 || samples[i] == 1.0)
    {
      ASSERT_NEAR(parts[i], samples[i], 0.02) << i; // what 16 samples do not see
      whole += samples[i] == 1.0 && parts[i] == 1.0;
    }
  }
  EXPECT_GT(whole, 100);
}

TEST_F(SurfaceFractionTest, TurnsAndMirrorsWithTheMesh)
{
  const int size = 24;
  const Grid grid = CubeGrid(size);
  const TriangleMesh mesh = RoughTorus();
  const std::vector<double> parts = this->Occupancy(grid, mesh);
  const int orders[][3] = { { 0, 1, 2 }, { 0, 2, 1 }, { 1, 0, 2 }, { 1, 2, 0 }, { 2, 0, 1 }, { 2, 1, 0 } };
  for (const auto& order : orders)
  {
    for (int mirrors = 0; mirrors < 8; ++mirrors)
    {
      TriangleMesh turned = mesh;
      for (std::size_t p = 0; p < turned.points.size(); ++p)
      {
        for (int axis = 0; axis < 3; ++axis)
        {
          turned.points[p][axis] = (mirrors >> axis & 1 ? -1.0 : 1.0) * mesh.points[p][order[axis]];
        }
      }
      const bool odd =
        (order[1] != (order[0] + 1) % 3) != (mirrors == 1 || mirrors == 2 || mirrors == 4 || mirrors == 7);
      const std::vector<double> there = this->Parts(grid, { { &turned, odd ? -1 : 1 } })[0];
      std::vector<double> back(parts.size());
      for (std::size_t i = 0; i < there.size(); ++i)
      {
        const std::array<std::size_t, 3> voxel = { i % size, i / size % size, i / (size * size) };
        std::array<std::size_t, 3> from;
        for (int axis = 0; axis < 3; ++axis)
        {
          from[order[axis]] = mirrors >> axis & 1 ? size - 1 - voxel[axis] : voxel[axis];
        }
        back[(from[2] * size + from[1]) * size + from[0]] = there[i];
      }
      EXPECT_TRUE(back == parts) << order[0] << order[1] << order[2] << " mirrors " << mirrors;
    }
  }
}

TEST_F(SurfaceFractionTest, VolumesAreNearerThanBySamples)
{
  const std::pair<const char*, TriangleMesh> shapes[] = {
    { "sphere", shapes::Sphere({ 0.01, 0.02, -0.03 }, 0.8) },
    { "torus", shapes::Torus({ 0.01, 0.02, -0.03 }, 0.6, 0.25) },
    { "box", shapes::Box({ -0.503, -0.411, -0.617 }, { 0.511, 0.423, 0.605 }) },
    { "turned box", shapes::TurnedBox({ -0.5, -0.4, -0.6 }, { 0.5, 0.4, 0.6 }) },
  };
  for (const auto& [name, mesh] : shapes)
  {
    for (int size : { 32, 64 })
    {
      const double samples = std::abs(this->VolumeError(CubeGrid(size), mesh, 4, false));
      const double fractions = std::abs(this->VolumeError(CubeGrid(size), mesh, 4, true));
      std::printf("%s %d: %.3g by samples, %.3g\n", name, size, samples, fractions);
      EXPECT_LT(fractions, samples) << name << size;
      EXPECT_LT(fractions, 2e-5) << name << size;
    }
  }
}

TEST_F(SurfaceFractionTest, ErrorOfOccupancyFallsWithTheSquareOfTheFactor)
{
  const Grid grid = CubeGrid(32);
  const TriangleMesh sphere = shapes::Sphere({ 0.01, 0.02, -0.03 }, 0.8);
  const std::vector<double> fine = this->Occupancy(grid, sphere, 16);
  std::array<std::vector<double>, 2> errors;
  for (int samples : { 1, 2, 4, 8 })
  {
    for (bool fractions : { false, true })
    {
      const std::vector<double> parts = this->Occupancy(grid, sphere, samples, fractions);
      double sum = 0.0;
      for (std::size_t i = 0; i < parts.size(); ++i)
      {
        sum += (parts[i] - fine[i]) * (parts[i] - fine[i]);
      }
      errors[fractions].push_back(std::sqrt(sum / parts.size()));
    }
    std::printf("%d: %.3g by samples, %.3g\n", samples, errors[0].back(), errors[1].back());
    EXPECT_LT(errors[1].back(), 0.5 * errors[0].back());
  }
  for (std::size_t k = 1; k < errors[1].size(); ++k)
  {
    EXPECT_LT(errors[1][k], 0.35 * errors[1][k - 1]);
  }
}

TEST_F(SurfaceFractionTest, GoesByParityAsSamplesDo)
{
  const Grid grid = CubeGrid(32);
  const TriangleMesh large = shapes::Sphere({ 0, 0, 0 }, 0.8, 4), small = shapes::Sphere({ 0.1, 0, 0 }, 0.4, 4);
  const TriangleMesh inverted = shapes::Inverted(large);
  EXPECT_TRUE(this->Parts(grid, { { &inverted, -1 } }) == this->Parts(grid, { { &large } }));
  EXPECT_TRUE(this->Parts(grid, { { &inverted, 0 } }) == this->Parts(grid, { { &large, 0 } }));
  const std::vector<double> hollow = this->Occupancy(grid, shapes::Collective(large, shapes::Inverted(small)));
  EXPECT_TRUE(this->Occupancy(grid, shapes::Collective(large, small)) == hollow);
  const std::vector<double> ofLarge = this->Occupancy(grid, large), ofSmall = this->Occupancy(grid, small);
  for (std::size_t i = 0; i < hollow.size(); ++i)
  {
    ASSERT_NEAR(hollow[i], ofLarge[i] - ofSmall[i], 1e-4);
  }
}

TEST_F(SurfaceFractionTest, ThinPlatesKeepTheirVolume)
{
  // Thinner than a sample is wide: samples see it here and there.
  const Grid grid = CubeGrid(32);
  for (double thickness : { 0.2, 0.6, 1.4 })
  {
    const double t = thickness / 128.0;
    const TriangleMesh plate = shapes::TurnedBox({ -0.6, -0.5, -t }, { 0.6, 0.5, t });
    const double error = this->VolumeError(grid, plate, 4, true);
    std::printf("%g samples: %.3g\n", thickness, error);
    EXPECT_LT(std::abs(error), 0.05) << thickness;
  }
}

TEST_F(SurfaceFractionTest, OfSeveralMeshesAddUp)
{
  const Grid grid = CubeGrid(30);
  const TriangleMesh glass = shapes::Sphere({ 0, 0, 0 }, 0.8, 4);
  const TriangleMesh air = shapes::Sphere({ 0.1, 0, 0 }, 0.4, 4);
  // Its face lies where no sample is between it and the next voxels.
  const TriangleMesh box = shapes::Box({ -0.3995, -0.2, -0.2 }, { 0.2, 0.2, 0.2 });
  const std::vector<double> alone = this->Occupancy(grid, glass);
  for (const TriangleMesh* inner : { &air, &box })
  {
    const auto parts = this->Parts(grid, { { &glass }, { inner } });
    const std::vector<double> ofInner = this->Occupancy(grid, *inner);
    EXPECT_TRUE(parts[1] == ofInner);
    for (std::size_t i = 0; i < alone.size(); ++i)
    {
      ASSERT_NEAR(parts[0][i] + parts[1][i], alone[i], 1e-9) << i;
    }
  }
  // The same mesh twice: the later one has it all, and nothing is left.
  const auto twice = this->Parts(grid, { { &glass }, { &glass } });
  EXPECT_TRUE(twice[1] == alone);
  EXPECT_LT(*std::max_element(twice[0].begin(), twice[0].end()), 1e-3);
}

TEST_F(SurfaceFractionTest, MeshesThatTouchShareTheirBorder)
{
  const TriangleMesh whole = shapes::Box({ -0.81, -0.81, -0.81 }, { 0.81, 0.81, 0.81 });
  const double cut[4] = { -0.123, 0.321, 0.057, 0.501 };
  TriangleMesh lower = whole, upper = whole;
  for (std::size_t k = 0; k < 4; ++k)
  {
    upper.points[k][2] = lower.points[k + 4][2] = cut[k];
  }
  upper.triangles[0] = { 0, 2, 1 }; // the diagonal of the other side
  upper.triangles[1] = { 1, 2, 3 };
  lower.triangles[2] = { 4, 5, 6 };
  lower.triangles[3] = { 5, 7, 6 };
  const Grid grid = CubeGrid(24);
  const std::vector<double> all = this->Occupancy(grid, whole);
  const auto parts = this->Parts(grid, { { &lower }, { &upper } });
  for (std::size_t i = 0; i < all.size(); ++i)
  {
    // Where the cut meets the walls, both faces' corrections are to second order.
    ASSERT_NEAR(parts[0][i] + parts[1][i], all[i], all[i] == 1.0 ? 1e-9 : 0.03) << i;
  }
}
}
