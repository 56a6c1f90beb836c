#include "ErrorWords.h"
#include "MeshShapes.h"

#include "Refraction/Voxelization/TriangleMesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

using namespace tyndall;

namespace
{
TEST(TriangleMesh, ClosedMeshesAreClosed)
{
  for (const TriangleMesh& mesh : { shapes::Box({ -1, -2, -3 }, { 1, 2, 3 }), shapes::Torus({ 0, 0, 0 }, 2, 1, 12, 7),
         shapes::Sphere({ 0, 0, 0 }, 1, 3) })
  {
    const MeshTopology topology = Examine(mesh);
    EXPECT_EQ(topology.boundaryEdges, 0u);
    EXPECT_EQ(topology.disagreeingEdges, 0u);
    EXPECT_EQ(topology.degenerateTriangles, 0u);
    EXPECT_GT(topology.enclosedVolume, 0.0);
  }
  EXPECT_DOUBLE_EQ(Examine(shapes::Box({ 1e6, 0, 0 }, { 1e6 + 1, 2, 3 })).enclosedVolume, 6.0);
}

TEST(TriangleMesh, CountsBoundaryEdges)
{
  TriangleMesh mesh = shapes::Box({ 0, 0, 0 }, { 1, 1, 1 });
  mesh.triangles.pop_back();
  const MeshTopology one = Examine(mesh);
  EXPECT_EQ(one.boundaryEdges, 3u);
  EXPECT_EQ(one.firstBoundaryEdge[0], (shapes::Point{ 1, 0, 0 }));
  EXPECT_EQ(one.firstBoundaryEdge[1], (shapes::Point{ 1, 0, 1 }));
  mesh.triangles.pop_back();
  EXPECT_EQ(Examine(mesh).boundaryEdges, 4u); // the whole face is gone
}

TEST(TriangleMesh, EdgesOfThreeTrianglesAreBoundaries)
{
  TriangleMesh mesh = shapes::Box({ 0, 0, 0 }, { 1, 1, 1 });
  mesh.points.push_back({ 0.5, -1.0, 0.5 });
  mesh.triangles.push_back({ 0, 1, 8 }); // a fin
  EXPECT_EQ(Examine(mesh).boundaryEdges, 3u);
}

TEST(TriangleMesh, PointsAtTheSamePlaceAreOne)
{
  TriangleMesh mesh = shapes::Sphere({ 0, 0, 0 }, 1, 2); // has no two triangles that share a point
  EXPECT_EQ(mesh.points.size(), 3 * mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.points.size(); i += 2)
  {
    for (double& coordinate : mesh.points[i])
    {
      coordinate = coordinate == 0.0 ? -0.0 : coordinate; // the same place
    }
  }
  EXPECT_EQ(Examine(mesh).boundaryEdges, 0u);
}

TEST(TriangleMesh, InsideOutHasNegativeVolume)
{
  const MeshTopology topology = Examine(shapes::Inverted(shapes::Box({ 0, 0, 0 }, { 1, 2, 3 })));
  EXPECT_DOUBLE_EQ(topology.enclosedVolume, -6.0);
  EXPECT_EQ(topology.disagreeingEdges, 0u);
}

TEST(TriangleMesh, OneTurnedTriangleDisagrees)
{
  TriangleMesh mesh = shapes::Box({ 0, 0, 0 }, { 1, 1, 1 });
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  const MeshTopology topology = Examine(mesh);
  EXPECT_EQ(topology.disagreeingEdges, 3u);
  EXPECT_EQ(topology.boundaryEdges, 0u);
}

TEST(TriangleMesh, CountsTrianglesWithoutArea)
{
  TriangleMesh mesh = shapes::Box({ 0, 0, 0 }, { 1, 1, 1 });
  mesh.triangles.push_back({ 2, 2, 5 });
  mesh.triangles.push_back({ 5, 5, 5 });
  const MeshTopology topology = Examine(mesh);
  EXPECT_EQ(topology.degenerateTriangles, 2u);
  EXPECT_EQ(topology.firstDegenerateTriangle, 12u);
  EXPECT_EQ(topology.boundaryEdges, 0u);
}

TEST(TriangleMesh, RefusesNumbersWithoutMeaning)
{
  const auto refused = [](const TriangleMesh& mesh, const char* part) {
    const std::string words = ErrorWords([&] { Examine(mesh); });
    EXPECT_THAT(words, testing::HasSubstr(part));
  };
  refused({}, "empty: it has 0 triangles, and 0 boundary edges");
  TriangleMesh mesh = shapes::Box({ 0, 0, 0 }, { 1, 1, 1 });
  mesh.triangles[4][1] = 8;
  refused(mesh, "Triangle 4 of the mesh has the corner 8");
  mesh.triangles[4][1] = -1;
  refused(mesh, "the corner -1");
  mesh = shapes::Box({ 0, 0, 0 }, { 1, 1, 1 });
  mesh.points[6][2] = std::numeric_limits<double>::quiet_NaN();
  refused(mesh, "Point 6 of the mesh is at (");
  mesh.pointNumbers = { 10, 11, 12, 13, 14, 15, 1006, 17 };
  refused(mesh, "Point 1006 of the mesh is at (");
}
}
