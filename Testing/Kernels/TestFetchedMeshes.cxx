#include "DeviceTest.h"
#include "PlyFile.h"
#include "WholeCounts.h"

#include "Refraction/Index/RefractiveMedium.h"
#include "Refraction/Voxelization/TriangleMesh.h"

#include <gmock/gmock.h>

#include <fstream>
#include <numeric>

using namespace tyndall;

// Real meshes, of CGAL's demos: `./run test` fetches them; without them these tests are skipped.
namespace
{
std::string FileOf(const std::string& name)
{
  return std::string(TYNDALL_FETCHED_DATA) + "/" + name + ".ply";
}

bool IsThere(const std::string& name)
{
  return static_cast<bool>(std::ifstream(FileOf(name)));
}

struct Case
{
  const char* mesh;
  int size;
};

class FetchedMesh
  : public DeviceTest
  , public testing::WithParamInterface<Case>
{
};

TEST_P(FetchedMesh, IsTheSameFromAllSidesAndHasItsVolume)
{
  if (!IsThere(GetParam().mesh))
  {
    GTEST_SKIP() << FileOf(GetParam().mesh) << " is not there";
  }
  const Solid solid = { GetParam().mesh, ReadPly(FileOf(GetParam().mesh)), {} };
  const int size = GetParam().size;
  const Grid grid = GridAround({ solid }, { size, size, size }, 0.125, 9);
  VoxelizationSettings settings;
  std::vector<cl_ushort> first;
  for (settings.columnAxis = 0; settings.columnAxis < 3; ++settings.columnAxis)
  {
    WholeCounts whole = CountWhole(this->GetDevice(), grid, { { &solid.mesh } }, settings);
    EXPECT_EQ(whole.windings[0].oddSamples, 0u);
    first = first.empty() ? whole.counts[0] : first;
    EXPECT_TRUE(whole.counts[0] == first) << "axis " << settings.columnAxis;
  }
  const double volume =
    std::accumulate(first.begin(), first.end(), 0.0) / (64.0 * UnitsOfSample(4)) * grid.VoxelVolume();
  const MeshTopology topology = Examine(solid.mesh);
  EXPECT_NEAR(volume, topology.enclosedVolume, 1e-3 * topology.enclosedVolume);
  EXPECT_THAT(Oddities(topology, {}, "It", grid, 4), testing::IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(Meshes, FetchedMesh,
  testing::Values(Case{ "armadillo", 64 }, Case{ "armadillo", 128 }, Case{ "armadillo", 256 }, Case{ "elephant", 64 },
    Case{ "elephant", 128 }, Case{ "elephant", 256 }),
  [](const auto& info) { return std::string(info.param.mesh) + std::to_string(info.param.size); });

TEST(OpenMeshes, HaveTheirNumbersOfBoundaryEdges)
{
  const std::pair<const char*, std::size_t> open[] = { { "elephant-with-holes", 1353 }, { "mech-holes-shark", 304 },
    { "lion-head", 36 } };
  for (const auto& [name, count] : open)
  {
    if (!IsThere(name))
    {
      GTEST_SKIP() << FileOf(name) << " is not there";
    }
    EXPECT_EQ(Examine(ReadPly(FileOf(name))).boundaryEdges, count) << name;
  }
}
}
